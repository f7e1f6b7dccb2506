# Fails if an archive defines or needs a global symbol of Vulkan. The libraries must get Vulkan's
# functions from the caller through vkGetInstanceProcAddr.
# Run with -DNM=... -DARCHIVES=...
foreach(archive IN LISTS ARCHIVES)
  execute_process(COMMAND ${NM} --extern-only ${archive} OUTPUT_VARIABLE symbols
    COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[A-Za-z] vk[A-Z][A-Za-z0-9]*" vulkan_symbols "${symbols}")
  if(vulkan_symbols)
    message(FATAL_ERROR "${archive} has global symbols of Vulkan's: ${vulkan_symbols}")
  endif()
  # An archive that was read wrongly has no symbols at all.
  if(NOT symbols MATCHES "alcove")
    message(FATAL_ERROR "${archive} has no symbols of Alcove's.")
  endif()
endforeach()
