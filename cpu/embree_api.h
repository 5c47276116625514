/// Embree 3.13 and Embree 4 behind one set of names. The only include of Embree in the library.
#pragma once

#if TANDEM_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tandem::embree {

#if TANDEM_EMBREE_MAJOR == 4
using QueryContext = RTCRayQueryContext;
#else
using QueryContext = RTCIntersectContext;
#endif

/// Prepares the QueryContext of a context that extends it. `coherent`: the rays of a packet are similar.
inline void init_context(QueryContext& context, bool coherent) {
#if TANDEM_EMBREE_MAJOR == 4
    rtcInitRayQueryContext(&context);
    (void)coherent;
#else
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
#endif
}

#if TANDEM_EMBREE_MAJOR == 4
inline RTCIntersectArguments arguments(QueryContext& context, bool coherent) {
    RTCIntersectArguments result;
    rtcInitIntersectArguments(&result);
    result.context = &context;
    result.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return result;
}
#endif

inline void intersect1(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
#if TANDEM_EMBREE_MAJOR == 4
    RTCIntersectArguments args = arguments(context, false);
    rtcIntersect1(scene, &ray, &args);
#else
    rtcIntersect1(scene, &context, &ray);
#endif
}

#if TANDEM_EMBREE_MAJOR == 4
inline RTCOccludedArguments occluded_arguments(QueryContext& context, bool coherent) {
    RTCOccludedArguments result;
    rtcInitOccludedArguments(&result);
    result.context = &context;
    result.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return result;
}
#endif

inline void occluded1(RTCScene scene, QueryContext& context, RTCRay& ray) {
#if TANDEM_EMBREE_MAJOR == 4
    RTCOccludedArguments args = occluded_arguments(context, false);
    rtcOccluded1(scene, &ray, &args);
#else
    rtcOccluded1(scene, &context, &ray);
#endif
}

/// Packets of 4, 8 or 16 rays, by the type of the packet. `valid`: -1 for active lanes, aligned like the packet.
#if TANDEM_EMBREE_MAJOR == 4
#define TANDEM_EMBREE_PACKET(n)                                                                         \
    inline void intersect(const int* valid, RTCScene scene, QueryContext& context, RTCRayHit##n& ray) { \
        RTCIntersectArguments args = arguments(context, true);                                          \
        rtcIntersect##n(valid, scene, &ray, &args);                                                     \
    }                                                                                                   \
    inline void occluded(const int* valid, RTCScene scene, QueryContext& context, RTCRay##n& ray) {     \
        RTCOccludedArguments args = occluded_arguments(context, true);                                  \
        rtcOccluded##n(valid, scene, &ray, &args);                                                      \
    }
#else
#define TANDEM_EMBREE_PACKET(n)                                                                         \
    inline void intersect(const int* valid, RTCScene scene, QueryContext& context, RTCRayHit##n& ray) { \
        rtcIntersect##n(valid, scene, &context, &ray);                                                  \
    }                                                                                                   \
    inline void occluded(const int* valid, RTCScene scene, QueryContext& context, RTCRay##n& ray) {     \
        rtcOccluded##n(valid, scene, &context, &ray);                                                   \
    }
#endif
TANDEM_EMBREE_PACKET(4)
TANDEM_EMBREE_PACKET(8)
TANDEM_EMBREE_PACKET(16)
#undef TANDEM_EMBREE_PACKET

template <int lanes>
struct Packet;
template <>
struct Packet<4> {
    using Ray = RTCRay4;
    using RayHit = RTCRayHit4;
    using Hit = RTCHit4;
};
template <>
struct Packet<8> {
    using Ray = RTCRay8;
    using RayHit = RTCRayHit8;
    using Hit = RTCHit8;
};
template <>
struct Packet<16> {
    using Ray = RTCRay16;
    using RayHit = RTCRayHit16;
    using Hit = RTCHit16;
};

}  // namespace tandem::embree
