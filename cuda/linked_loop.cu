#include "cuda/linked_kernel.h"

TANDEM_LINKED_KERNEL(tandem::LoopTracer)
