// The dense part of a sparse Cholesky factorisation: blocks of columns of a symmetric matrix, and
// their effect on the columns behind them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>

#include "incise/physics/elements/processor.h"

namespace incise::physics {

/// A symmetric matrix whose first rows and columns are to be eliminated. It is stored column by
/// column. Only its lower half counts; what is above the diagonal has any values. Each column is
/// followed by `padding` zeros, so that kernels need not end where rows do.
struct DenseFront {
    double* values;
    std::size_t size;  ///< number of rows and columns

    static constexpr std::size_t padding = 24;  ///< at least the rows of a tile on any processor
    std::size_t stride() const { return size + padding; }
    double* column(std::size_t j) const { return values + j * stride(); }
    static std::size_t num_values(std::size_t size) { return size * (size + padding); }
};

/// The smallest and the largest pivot, squares of entries of the diagonal of the factor.
struct PivotRange {
    double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
};

/// The number of columns that are eliminated together.
inline constexpr std::size_t columns_together = 96;

/// The numbers of a block of eliminated columns, below a row, in the order in which they are read.
struct PackedColumns {
    double* values;         ///< aligned to 64 bytes
    std::size_t first_row;  ///< what is below it is packed
    std::size_t depth;      ///< number of columns

    static std::size_t num_values(std::size_t num_rows, std::size_t depth) {
        return (num_rows + DenseFront::padding) * depth;
    }
};

/// The kernels, compiled for each kind of processor. Each entry of the factor is computed from its
/// own value by the same operations in the same order, whatever the sizes of blocks and tiles. So
/// the bits are the same on every processor, and for any number of threads.
struct FrontKernels {
    /// Eliminates the columns from `first` to before `last` of the block: in all rows, they become
    /// those of the Cholesky factor L of L L^T. Columns behind the block are not changed. Returns
    /// false at a pivot that is not positive, and then leaves the block half done.
    /// @param scratch  aligned to 64 bytes, PackedColumns::num_values(size, columns_together)
    bool (*eliminate)(const DenseFront& front, std::size_t first, std::size_t last, double* scratch,
                      PivotRange& pivots);
    /// Packs the columns from `first` on, for subtract(), from packed.first_row on.
    void (*pack)(const DenseFront& front, std::size_t first, const PackedColumns& packed);
    /// Subtracts the products of packed columns from strip `strip` of the lower half behind
    /// packed.first_row: rows_of_strip rows, or less at the end.
    void (*subtract)(const DenseFront& front, const PackedColumns& packed, std::size_t strip);
    std::size_t rows_of_strip;
};

/// Returns the kernels for a processor.
const FrontKernels& front_kernels_for(Processor processor);

}  // namespace incise::physics
