#include "hierarchy/volume/material.h"

#include <gtest/gtest.h>

namespace terrane::hierarchy::volume {
namespace {

constexpr InterfaceId kGround{0}, kLake{1};
constexpr Mask kBelowGround = 1, kBelowLake = 2;
constexpr Mask kRock = 1, kWater = 2, kAir = 4;

const std::vector<Material> kMaterials = {
    {"rock", {{kGround, true}}}, {"water", {{kLake, true}}}, {"air", {}}};

TEST(Material, TheFirstThatFitsIsThere) {
  EXPECT_EQ(material_at(kMaterials, kBelowGround | kBelowLake), MaterialId{0});
  EXPECT_EQ(material_at(kMaterials, kBelowLake), MaterialId{1});
  EXPECT_EQ(material_at(kMaterials, 0), MaterialId{2});
}

TEST(Material, OpenSidesMakeSeveralPossible) {
  EXPECT_EQ(possible_materials(kMaterials, kBelowGround, kBelowLake), kRock);
  EXPECT_EQ(possible_materials(kMaterials, 0, kBelowLake), kWater | kAir);
  EXPECT_EQ(possible_materials(kMaterials, 0, kBelowGround | kBelowLake), kRock | kWater | kAir);
}

TEST(Material, AnInterfaceUnderTheGroundPartsNothing) {
  EXPECT_EQ(parting_interfaces(kMaterials, kBelowGround, kBelowLake), 0);
  EXPECT_EQ(parting_interfaces(kMaterials, 0, kBelowLake), kBelowLake);
  EXPECT_EQ(parting_interfaces(kMaterials, 0, kBelowGround | kBelowLake),
            kBelowGround | kBelowLake);
}

}  // namespace
}  // namespace terrane::hierarchy::volume
