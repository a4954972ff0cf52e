// Ids of the things of a world, and tables of them from archives.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/handles.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "incise/base/archive.h"
#include "incise/base/error.h"

namespace incise::sim {
namespace {

using Id = Handle<struct ThingTag>;
using Table = HandleTable<Id>;
using Row = std::pair<std::uint32_t, std::uint32_t>;  // index, generation

/// Returns a table as an archive with these rows gives it.
Table table_of(const std::vector<Row>& rows, std::uint32_t next, std::size_t count) {
    ArchiveWriter out;
    out(rows, next);
    const std::string bytes = out.take();
    ArchiveReader in(bytes);
    Table table("thing", 7);
    in(table);
    table.complete(count);
    return table;
}

TEST(HandleTable, UsesFreePlacesAgainForOtherIds) {
    Table table("thing", 1, 4);
    const std::vector<Id> first(table.all().begin(), table.all().end());
    table.remove(first[1]);
    table.remove(first[0]);
    EXPECT_EQ(table.position_of(first[2]), 0u);
    EXPECT_EQ(table.position_of(first[3]), 1u);
    const Id again = table.add();
    EXPECT_EQ(again.index, first[0].index);
    EXPECT_EQ(table.position_of(again), 2u);
    EXPECT_EQ(table.add().index, first[1].index);
    EXPECT_EQ(table.add().index, 4u);
    EXPECT_THROW(table.position_of(first[0]), InputError);
    EXPECT_THROW(table.position_of(Id()), InputError);
}

TEST(HandleTable, KnowsIdsOfTheStateThatItWasReadFrom) {
    Table saved("thing", 3);
    const Id kept = saved.add(), removed = saved.add();
    saved.remove(removed);
    ArchiveWriter out;
    out(saved);
    const std::string bytes = out.take();
    const Id later = saved.add();
    ArchiveReader in(bytes);
    Table read("thing", 4);
    in(read);
    read.complete(1);
    EXPECT_EQ(read.position_of(kept), 0u);
    EXPECT_EQ(read.position_of(read.all()[0]), 0u);
    EXPECT_EQ(read.all()[0], kept);
    // It goes on as the saved one did, to the same bytes, and tells both additions apart.
    const Id own = read.add();
    EXPECT_EQ(own.generation, later.generation);
    EXPECT_EQ(read.position_of(own), 1u);
    EXPECT_THROW(read.position_of(later), InputError);
    EXPECT_THROW(read.position_of(removed), InputError);
    EXPECT_THROW(saved.position_of(own), InputError);
    ArchiveWriter one, other;
    one(saved);
    other(read);
    EXPECT_EQ(one.take(), other.take());
}

TEST(HandleTable, RefusesRowsThatCannotBe) {
    constexpr std::uint32_t most = -1;
    EXPECT_EQ(table_of({{0, 1}, {5, 2}}, 3, 2).all().size(), 2u);
    EXPECT_THROW(table_of({{0, 1}, {5, 2}}, 3, 3), InputError);  // too few
    EXPECT_THROW(table_of({{0, 1}, {0, 2}}, 3, 2), InputError);  // one place twice
    EXPECT_THROW(table_of({{0, 1}, {1, 1}}, 3, 2), InputError);  // one generation twice
    EXPECT_THROW(table_of({{0, 0}}, 3, 1), InputError);          // that of no thing
    EXPECT_THROW(table_of({{0, 3}}, 3, 1), InputError);          // not given out yet
    EXPECT_THROW(table_of({{0, 1}}, most, 1), InputError);       // about to overflow
    EXPECT_THROW(table_of({{0, most - 1}}, most, 1), InputError);
    EXPECT_THROW(table_of({{most, 1}}, 3, 1), InputError);  // no such place
    EXPECT_THROW(table_of({}, 0, 0), InputError);
}

}  // namespace
}  // namespace incise::sim
