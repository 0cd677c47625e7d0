// clang 14 and the gcc that deal.II was compiled with give the products of Trilinos' matrices with vectors different names:
// here clang's lead to gcc's.
// clang-format off
#define LATCON_SAME(VECTOR, CLANG, GCC)                                                                                           \
  asm(".globl _ZNK6dealii16TrilinosWrappers12SparseMatrix5vmult" VECTOR                                                          \
      "NSt9enable_ifIXsr3std7is_sameINT_10value_typeEdEE5valueEvE4typeER" CLANG "RK" CLANG "\n"                                   \
      "_ZNK6dealii16TrilinosWrappers12SparseMatrix5vmult" VECTOR                                                                 \
      "NSt9enable_ifIXsr3std7is_sameINT_10value_typeEdEE5valueEvE4typeER" CLANG "RK" CLANG ":\n"                                  \
      "jmp _ZNK6dealii16TrilinosWrappers12SparseMatrix5vmult" VECTOR                                                             \
      "NSt9enable_ifIXsrSt7is_sameINT_10value_typeEdE5valueEvE4typeER" GCC "RK" GCC "@PLT\n")

LATCON_SAME("INS0_3MPI6VectorEEE", "S6_", "S7_");
