# cmake -DINPUT=... -DOUTPUT=... -DNAMESPACE=... -DNAME=... -P embed_bytes.cmake: writes a C++ file with a function
#
#   std::span<const std::byte> NAMESPACE::NAME()
#
# that returns the bytes of the input file.
file(READ ${INPUT} digits HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${digits}")
string(REPEAT "." 80 line)
string(REGEX REPLACE "(${line})" "\\1\n" bytes "${bytes}")
file(
  WRITE ${OUTPUT}
  "#include <cstddef>\n#include <span>\n\n"
  "alignas(16) static const unsigned char bytes[] = {\n${bytes}};\n\n"
  "namespace ${NAMESPACE} {\n\n"
  "std::span<const std::byte> ${NAME}();\n"
  "std::span<const std::byte> ${NAME}() { return std::as_bytes(std::span(bytes)); }\n\n"
  "}  // namespace ${NAMESPACE}\n"
)
