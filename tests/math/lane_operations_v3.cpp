#include "math/lane_operations_body.h"

tandem::test::LaneOperations tandem::test::lane_operations_v3() { return all_operations<Lanes<float, Avx2>>(); }
