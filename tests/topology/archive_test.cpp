// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/archive.h"

#include <gtest/gtest.h>

#include <limits>

#include "incise/topology/change_set.h"

namespace incise::topology {
namespace {

struct Thing {
    bool flag = false;
    int number = 0;
    std::vector<std::string> names;
    std::unordered_map<std::int32_t, std::vector<VertexId>> lists;
    std::unordered_set<std::int32_t> set;
    std::pair<VertexId, int> pair;
    std::array<double, 2> values{};
    Eigen::AlignedBox3d box;
    static void archive(auto& ar, auto& self) {
        ar(self.flag, self.number, self.names, self.lists, self.set, self.pair, self.values,
           self.box);
    }
};

Thing thing() {
    Thing t{true, -7, {"a", ""}, {}, {}, {VertexId(3), 2}, {-0.0, 5e-324}, {}};
    for (int i = 20; i > 0; --i) {
        t.lists[i * 37] = {VertexId(static_cast<std::size_t>(i)), VertexId()};
        t.set.insert(i * i);
    }
    return t;
}

std::string bytes_of(const auto& value) {
    ArchiveWriter ar;
    ar(value);
    return ar.bytes();
}

TEST(Archive, GivesBackWhatItTookToTheBit) {
    const std::string bytes = bytes_of(thing());
    ArchiveReader ar(bytes);
    const auto back = ar.read<Thing>();
    EXPECT_TRUE(ar.is_at_end());
    EXPECT_EQ(bytes_of(back), bytes);
    EXPECT_TRUE(back.flag);
    EXPECT_EQ(back.names, thing().names);
    EXPECT_EQ(back.lists, thing().lists);
    EXPECT_EQ(back.set, thing().set);
    EXPECT_TRUE(std::signbit(back.values[0]));
    EXPECT_TRUE(back.box.isEmpty());
}

TEST(Archive, IsLittleEndianWithoutPadding) {
    EXPECT_EQ(bytes_of(std::int32_t{0x01020304}), std::string("\x04\x03\x02\x01"));
    EXPECT_EQ(bytes_of(1.0), std::string("\0\0\0\0\0\0\xf0\x3f", 8));
    EXPECT_EQ(bytes_of(std::string("ab")), std::string("\2\0\0\0\0\0\0\0ab", 10));
}

TEST(Archive, IsTheSameForSetsInAnyOrder) {
    Thing other = thing();
    other.set.clear();
    other.set.reserve(1000);
    for (int i = 1; i <= 20; ++i) other.set.insert(i * i);
    EXPECT_EQ(bytes_of(other), bytes_of(thing()));
}

TEST(Archive, RefusesBytesThatEndTooEarly) {
    const std::string bytes = bytes_of(thing());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        ArchiveReader ar(std::string_view(bytes).substr(0, size));
        EXPECT_THROW(ar.read<Thing>(), InputError) << size;
    }
    // A count beyond all that is there takes no memory.
    const std::string many = bytes_of(std::numeric_limits<std::uint64_t>::max());
    ArchiveReader ar(many);
    EXPECT_THROW(ar.read<std::vector<double>>(), InputError);
}

TEST(Archive, KeepsEdits) {
    ChangeSet changes;
    changes.epoch_after = 1;
    changes.node_capacity_after = 9;
    changes.nodes_added.push_back({VertexId(8), Vec3(1, 2, 3), {}, 2});
    changes.nodes_added[0].sources[1] = {VertexId(4), 0.25};
    changes.elements_added.push_back(
        {CellId(5), CellKind::hexahedron, 7, CellId(2), {VertexId(1), VertexId(8)}});
    changes.elements_removed.push_back({CellId(1), CellKind::tetrahedron, 0, {}, {VertexId(0)}});
    changes.rewired.push_back({CellId(2), 3, VertexId(4), VertexId(8)});
    changes.faces_opened.push_back({{CellId(1), 2}, {CellId(3), 0}});
    changes.faces_closed.push_back({{CellId(2), 1}, {CellId(5), 1}});
    const std::string bytes = bytes_of(changes);
    ArchiveReader ar(bytes);
    EXPECT_EQ(ar.read<ChangeSet>(), changes);
    EXPECT_TRUE(ar.is_at_end());
}

}  // namespace
}  // namespace incise::topology
