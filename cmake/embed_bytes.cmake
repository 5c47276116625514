# cmake -DINPUT=... -DOUTPUT=... -DNAMESPACE=... -DNAME=... -P embed_bytes.cmake: writes a C++ file with a function
#
#   std::span<const std::byte> NAMESPACE::NAME()
#
# that returns the bytes of the input file. The assembler reads them: a compiler takes half a second for an array.
file(SIZE ${INPUT} size)
set(symbol tandem_bytes_${NAME})
file(
  WRITE ${OUTPUT}
  "#include <cstddef>\n#include <span>\n\n"
  "asm(\".section .rodata\\n\"\n"
  "    \".balign 16\\n\"\n"
  "    \".globl ${symbol}\\n\"\n"
  "    \".hidden ${symbol}\\n\"\n"
  "    \"${symbol}:\\n\"\n"
  "    \".incbin \\\"${INPUT}\\\"\\n\"\n"
  "    \".previous\\n\");\n"
  "extern \"C\" __attribute__((visibility(\"hidden\"))) const std::byte ${symbol}[${size}];\n\n"
  "namespace ${NAMESPACE} {\n\n"
  "std::span<const std::byte> ${NAME}();\n"
  "std::span<const std::byte> ${NAME}() { return ${symbol}; }\n\n"
  "}  // namespace ${NAMESPACE}\n"
)
