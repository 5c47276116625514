#include "cpu/kernels/render_entry.h"

namespace tandem {

template TileStats CpuKernels<TANDEM_KERNEL_ISA, Tier::TANDEM_KERNEL_TIER>::render_tile<variant_named("exact")>(
    const CpuSceneView&, const PixelJob&, const Tile&, Vec3d*);

}  // namespace tandem
