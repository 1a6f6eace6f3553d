# cmake -D OUTPUT=embedded.cpp -D HEADER=<momenta/dae/…> -D "FILES=name=path;name=path" -P embed.cmake
# Writes one function momenta::embedded::name() per file, returning its bytes. A byte array rather than string
# literals: no limit of length, nothing to escape.
set(text "#include ${HEADER}\n\nnamespace momenta::embedded {\n")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([a-z_]+)=(.*)$" whole "${entry}")
  set(name "${CMAKE_MATCH_1}")
  file(READ "${CMAKE_MATCH_2}" bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(REGEX REPLACE "(....................................................................................................)" "\\1\n" bytes "${bytes}")
  string(APPEND text "\nnamespace {\nconst unsigned char ${name}_bytes[] = {\n${bytes}0};\n}\n"
                     "std::string_view ${name}() {\n"
                     "  return {reinterpret_cast<const char*>(${name}_bytes), sizeof ${name}_bytes - 1};\n}\n")
endforeach()
string(APPEND text "\n}  // namespace momenta::embedded\n")
file(WRITE "${OUTPUT}" "${text}")
