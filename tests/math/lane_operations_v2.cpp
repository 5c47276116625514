#include "math/lane_operations_body.h"

tandem::test::LaneOperations tandem::test::lane_operations_v2() { return all_operations<Lanes<float, Sse4>>(); }
