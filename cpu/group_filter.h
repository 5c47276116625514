/// The filters of kernel/shapes/filter.h for all primitives of a group at once.
#pragma once

#include <cstring>

#include "cpu/primitive_groups.h"
#include "tandem/kernel/shapes/filter.h"
#include "tandem/math/lanes.h"

namespace tandem {

/// The lanes for the primitives of a group: those of I, but no more than a group has primitives.
template <class I>
struct GroupIsa {
    static constexpr int bytes = I::bytes < 4 * group_size ? I::bytes : 4 * group_size;
    static constexpr const char* name = I::name;
};

/// A ray that is the same in all lanes. In the tier precise it is rounded to float, which the filters allow for.
template <class W, class Real>
TANDEM_HD_INLINE FilterRay<W> in_all_lanes(const FilterRay<Real>& f) {
    const auto all = [](const auto& number) { return W(to_plain(number)); };
    const Vec3<Real>&o = f.ray.origin, &d = f.ray.direction;
    return {{{all(o.x), all(o.y), all(o.z)}, {all(d.x), all(d.y), all(d.z)}},
            all(f.origin_norm1),
            all(f.direction_length2)};
}

namespace group_detail {

template <class W, class T>
TANDEM_HD_INLINE W load(const T* numbers) {
    W result;
    std::memcpy(&result, numbers, sizeof(result));
    return result;
}

template <class W, int corners>
TANDEM_HD_INLINE Vec3<W> load_corner(const FaceGroup<corners>& group, int corner, int first) {
    return {load<W>(group.x[corner] + first), load<W>(group.y[corner] + first), load<W>(group.z[corner] + first)};
}

/// For primitives [first, first + W::size) of a group.
template <class W>
TANDEM_HD_INLINE Mask<W> may_touch(const FilterRay<W>& f, const BodyGroup& group, int first) {
    const Vec3<W> centre = {load<W>(group.x + first), load<W>(group.y + first), load<W>(group.z + first)};
    return may_touch_sphere(f, centre, load<W>(group.radius + first));
}
template <class W, int corners>
TANDEM_HD_INLINE Mask<W> may_touch(const FilterRay<W>& f, const FaceGroup<corners>& group, int first) {
    const Vec3<W> v0 = load_corner<W>(group, 0, first);
    const Vec3<W> v2 = load_corner<W>(group, 2, first);
    const Mask<W> touches = may_touch_triangle(f, v0, load_corner<W>(group, 1, first), v2);
    if constexpr (corners == 3) {
        return touches;
    } else {
        return touches || may_touch_triangle(f, v0, v2, load_corner<W>(group, 3, first));
    }
}

/// test(first) for each part of a group that fits into the lanes of W: bit i is the result for primitive i.
template <class W, class Group, class Test>
TANDEM_HD_INLINE unsigned test_parts(const Group& group, const Test& test) {
    using Word = UInt<W>;
    unsigned bits = 0;
    for (int first = 0; first < group_size; first += W::size) {
        const Mask<W> is_there = load<Word>(group.id + first) != Word(no_primitive);
        bits |= (is_there && test(first)).bits() << first;
    }
    return bits;
}

}  // namespace group_detail

/// The primitives of a group that a ray may touch, as bits; the others are certain misses.
template <class W, class Group>
TANDEM_HD_INLINE unsigned filter_group(const FilterRay<W>& f, const Group& group) {
    return group_detail::test_parts<W>(
        group, [&](int first) __attribute__((always_inline)) { return group_detail::may_touch(f, group, first); });
}

}  // namespace tandem
