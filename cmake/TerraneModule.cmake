# Warnings and checks that every target of ours is compiled with; never passed on to users.
add_library(terrane_build_flags INTERFACE)
# -Wmissing-field-initializers is off: it warns of every designated initializer that leaves a default
target_compile_options(terrane_build_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  -Wno-missing-field-initializers)
# the same bytes on every machine: no fused multiply-add where the source has none
target_compile_options(terrane_build_flags INTERFACE -ffp-contract=off)
if(TERRANE_SANITIZE)
  target_compile_options(terrane_build_flags INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(terrane_build_flags INTERFACE -fsanitize=address,undefined)
endif()

# terrane_add_module(NAME SOURCES ... HEADERS ... PUBLIC ... PRIVATE ...)
#
# Defines the static library terrane_NAME (alias terrane::NAME) of the calling folder. PUBLIC and
# PRIVATE name the only modules and libraries that it may know. Headers are installed under
# include/terrane/ with their path from the project's root.
function(terrane_add_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(target terrane_${name})
  add_library(${target} STATIC ${arg_SOURCES} ${arg_HEADERS})
  add_library(terrane::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/terrane>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target}
    PUBLIC ${arg_PUBLIC}
    PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:terrane_build_flags>)
  if(TERRANE_TIDY)
    set_target_properties(${target} PROPERTIES CXX_CLANG_TIDY "clang-tidy;--quiet")
  endif()

  install(TARGETS ${target} EXPORT terraneTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  foreach(header IN LISTS arg_HEADERS)
    get_filename_component(subfolder ${header} DIRECTORY)
    install(FILES ${header}
            DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/terrane/${folder}/${subfolder})
  endforeach()
endfunction()
