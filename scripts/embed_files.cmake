# Writes OUTPUT, a C++ file with FUNCTION (declared in HEADER, of NAMESPACE): the text of each file of FILES by its name.
set(text "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\n")
string(APPEND text "std::string_view ${FUNCTION}(std::string_view name) {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} source)
  # A library's pointer to its source map would have browsers look for a file that is not there.
  string(REGEX REPLACE "(//|/\\*)# sourceMappingURL=[^\n]*" "" source "${source}")
  string(APPEND text "    if (name == \"${name}\") return R\"FILE(${source})FILE\";\n")
endforeach()
string(APPEND text "    return {};\n}\n\n}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUTPUT} "${text}")
