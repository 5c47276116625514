// The facts of the toy kernel that is linked when the tests are built.
#include "cuda/toy_kernel.h"

extern "C" {
extern __device__ const tandem::test::ToyFacts toy_facts;
__device__ const tandem::test::ToyFacts toy_facts = tandem::test::compiled_toy_facts;
}
