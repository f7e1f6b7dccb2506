// Keeps drivers and layers loaded until the program ends, so that a leak report can name the
// module, and leaks.supp can suppress leaks by that name.
extern "C" int dlclose(void* /*module*/) { return 0; }
