// Elimination in dense fronts on lanes. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/dense_front.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "incise/physics/simd/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using Doubles = NumberFormat<double>::Vector;
constexpr std::size_t doubles_at_once = static_cast<std::size_t>(num_lanes<double>);
// A tile of sums stays in registers: 12 of 16 vectors with AVX2, 24 of 32 with AVX-512.
constexpr std::size_t vectors_of_tile = 3, rows_of_tile = vectors_of_tile * doubles_at_once,
                      columns_of_tile = doubles_at_once;
static_assert(rows_of_tile <= DenseFront::padding);
constexpr std::size_t tiles_of_strip = 96 / rows_of_tile;
constexpr std::size_t few_columns = 8;  // that one at a time eliminate each other
static_assert(few_columns % columns_of_tile == 0);

Doubles load(const double* from) {
    Doubles v;
    std::memcpy(&v, from, sizeof v);
    return v;
}
void store(Doubles v, double* to) { std::memcpy(to, &v, sizeof v); }

/// Subtracts from a tile of the front the products of packed rows `a` with `num_columns` packed
/// rows `b`; b[k * rows_of_tile + j] belongs to column j of the tile.
template <bool is_whole>
[[gnu::always_inline]] inline void subtract_tile(double* to, std::size_t stride, const double* a,
                                                 const double* b, std::size_t depth,
                                                 std::size_t num_columns) {
    Doubles sums[columns_of_tile][vectors_of_tile];
    for (std::size_t j = 0; j < columns_of_tile; ++j)
        for (std::size_t v = 0; v < vectors_of_tile; ++v)
            sums[j][v] = is_whole || j < num_columns ? load(to + j * stride + v * doubles_at_once)
                                                     : Doubles{};
    for (std::size_t k = 0; k < depth; ++k) {
        Doubles rows[vectors_of_tile];
        for (std::size_t v = 0; v < vectors_of_tile; ++v)
            rows[v] = load(a + k * rows_of_tile + v * doubles_at_once);
        for (std::size_t j = 0; j < columns_of_tile; ++j) {
            const Doubles factor = b[k * rows_of_tile + j] - Doubles{};
            for (std::size_t v = 0; v < vectors_of_tile; ++v)
                sums[j][v] = subtract_product(rows[v], factor, sums[j][v]);
        }
    }
    for (std::size_t j = 0; j < columns_of_tile; ++j)
        if (is_whole || j < num_columns)
            for (std::size_t v = 0; v < vectors_of_tile; ++v)
                store(sums[j][v], to + j * stride + v * doubles_at_once);
}

void pack(const DenseFront& front, std::size_t first, const PackedColumns& packed) {
    double* to = packed.values;
    for (std::size_t row = packed.first_row; row < front.size; row += rows_of_tile)
        for (std::size_t k = 0; k < packed.depth; ++k, to += rows_of_tile)
            std::memcpy(to, front.column(first + k) + row, rows_of_tile * sizeof(double));
}

/// Subtracts the products in the rows of some tiles, in the columns before `end_column`.
void subtract_tiles(const DenseFront& front, const PackedColumns& packed, std::size_t first_tile,
                    std::size_t last_tile, std::size_t end_column) {
    const std::size_t tile_size = rows_of_tile * packed.depth;
    for (std::size_t tile = first_tile; tile < last_tile; ++tile) {
        const std::size_t row = packed.first_row + tile * rows_of_tile;
        const double* const a = packed.values + tile * tile_size;
        const std::size_t end = std::min(end_column, row + rows_of_tile);
        for (std::size_t column = packed.first_row; column < end; column += columns_of_tile) {
            const std::size_t place = column - packed.first_row;
            const double* const b =
                packed.values + place / rows_of_tile * tile_size + place % rows_of_tile;
            double* const to = front.column(column) + row;
            if (end_column - column >= columns_of_tile)
                subtract_tile<true>(to, front.stride(), a, b, packed.depth, columns_of_tile);
            else
                subtract_tile<false>(to, front.stride(), a, b, packed.depth, end_column - column);
        }
    }
}

std::size_t num_tiles(const DenseFront& front, std::size_t first_row) {
    return (front.size - first_row + rows_of_tile - 1) / rows_of_tile;
}

void subtract(const DenseFront& front, const PackedColumns& packed, std::size_t strip) {
    const std::size_t first = strip * tiles_of_strip;
    subtract_tiles(front, packed, first,
                   std::min(first + tiles_of_strip, num_tiles(front, packed.first_row)),
                   front.size);
}

bool eliminate_few(const DenseFront& front, std::size_t first, std::size_t last,
                   PivotRange& pivots) {
    for (std::size_t j = first; j < last; ++j) {
        double* const column = front.column(j);
        // Whole vectors, which begin with the diagonal and end in the padding.
        for (std::size_t k = first; k < j; ++k) {
            const double* const earlier = front.column(k);
            const Doubles factor = earlier[j] - Doubles{};
            for (std::size_t i = j; i < front.size; i += doubles_at_once)
                store(subtract_product(load(earlier + i), factor, load(column + i)), column + i);
        }
        const double pivot = column[j];
        if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
        pivots.smallest = std::min(pivots.smallest, pivot);
        pivots.largest = std::max(pivots.largest, pivot);
        const double root = std::sqrt(pivot);
        const Doubles scale = 1.0 / root - Doubles{};
        for (std::size_t i = j; i < front.size; i += doubles_at_once)
            store(load(column + i) * scale, column + i);
        column[j] = root;
    }
    return true;
}

bool eliminate(const DenseFront& front, std::size_t first, std::size_t last, double* scratch,
               PivotRange& pivots) {
    if (last - first <= few_columns) return eliminate_few(front, first, last, pivots);
    const std::size_t half = (last - first) / 2;
    const std::size_t middle = first + (half + few_columns - 1) / few_columns * few_columns;
    if (!eliminate(front, first, middle, scratch, pivots)) return false;
    const PackedColumns packed{scratch, middle, middle - first};
    pack(front, first, packed);
    subtract_tiles(front, packed, 0, num_tiles(front, middle), last);
    return eliminate(front, middle, last, scratch, pivots);
}

}  // namespace

const FrontKernels& front_kernels() {
    static constexpr FrontKernels kernels{&eliminate, &pack, &subtract,
                                          tiles_of_strip * rows_of_tile};
    return kernels;
}

}  // namespace incise::physics::INCISE_PROCESSOR
