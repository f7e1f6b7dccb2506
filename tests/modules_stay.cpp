// Drivers and layers stay loaded to the end, so that a leak report can name the module it is about
// and leaks.supp can know it.
extern "C" int dlclose(void* /*module*/) { return 0; }
