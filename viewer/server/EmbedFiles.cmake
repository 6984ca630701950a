enable_language(ASM)

# terrane_embed_files(OUT_VAR FUNCTION NAME FROM DIR FILES relative/path...)
#
# Puts the content of files into the library and defines the function of viewer_files.h over them. The assembler
# reads them as they are (.incbin): a megabyte of C++ array would take the compiler seconds.
function(terrane_embed_files out_var)
  cmake_parse_arguments(arg "" "FUNCTION;FROM" "FILES" ${ARGN})
  set(assembly ${CMAKE_CURRENT_BINARY_DIR}/embedded_${arg_FUNCTION}.S)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded_${arg_FUNCTION}.cpp)
  set(count 0)
  foreach(file IN LISTS arg_FILES)
    set(symbol terrane_${arg_FUNCTION}_${count})
    string(APPEND symbols
      "  .global ${symbol}, ${symbol}_end\n"
      "${symbol}:\n  .incbin \"${arg_FROM}/${file}\"\n${symbol}_end:\n  .byte 0\n")
    string(APPEND declarations "extern const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND entries "      {\"${file}\", {${symbol}, ${symbol}_end}},\n")
    list(APPEND inputs ${arg_FROM}/${file})
    math(EXPR count "${count} + 1")
  endforeach()

  # CONFIGURE and not WRITE: files that did not change keep their time
  file(CONFIGURE OUTPUT ${assembly} @ONLY CONTENT
"  .section .rodata
${symbols}  .section .note.GNU-stack,\"\",@progbits
")
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT
"#include \"viewer/server/viewer_files.h\"

extern \"C\" {
${declarations}}

namespace terrane::viewer {

std::span<const ViewerFile> ${arg_FUNCTION}() {
  static const ViewerFile kFiles[] = {
${entries}  };
  return kFiles;
}

}  // namespace terrane::viewer
")
  set_source_files_properties(${assembly} PROPERTIES OBJECT_DEPENDS "${inputs}")
  set(${out_var} ${assembly} ${source} PARENT_SCOPE)
endfunction()
