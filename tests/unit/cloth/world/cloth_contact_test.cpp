// Contact of a scene's cloths around their steps, by itself: who is told of what, and who is led apart.
#include "cloth/world/cloth_contact.h"

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/cloth.h"
#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kThickness = 0.01;

/// Flat sheets of 1 m, `heights` over each other along z, without effects.
std::vector<Cloth<float>> sheets(const std::vector<double>& heights, const Vec3& aside = {0.03, 0.02, 0}) {
  std::vector<Cloth<float>> cloths;
  for (const double height : heights) {
    ClothDescription sheet;
    sheet.size = {1, 1};
    sheet.min_level = sheet.initial_level = 4;
    sheet.position = (cloths.size() % 2 == 0 ? Vec3(0, 0, 0) : aside) + Vec3(0, 0, height);
    cloths.emplace_back(sheet, std::vector<EffectDescription>{}, Bdf2Description{}, 1);
  }
  return cloths;
}

void move(Cloth<float>& cloth, const Vec3& by, double dt) {
  Particles<float>& particles = cloth.particles();
  each_node(particles.grid(), [&](int r, int c) {
    set(particles.position, r, c, get(particles.position, r, c) + by);
    set(particles.velocity, r, c, by / dt);
  });
}

double height(const Cloth<float>& cloth) { return centre(cloth.particles()).z(); }

TEST(ClothContact, WhatWouldPassThroughIsStopped) {
  std::vector<Cloth<float>> cloths = sheets({0, 0.05});
  ClothContact<float> contact(ClothContactEffect{.thickness = kThickness});
  contact.begin_step(cloths, kFrame);
  // Nobody steps them: the upper one is put under the lower one, as a step that missed the contact would.
  move(cloths[1], {0, 0, -0.1}, kFrame);
  contact.end_step(cloths, kFrame);
  EXPECT_GT(height(cloths[1]), height(cloths[0]));
}

TEST(ClothContact, WhatIsFarApartIsLeftToTheBit) {
  std::vector<Cloth<float>> cloths = sheets({0, 1});
  ClothContact<float> contact(ClothContactEffect{.thickness = kThickness});
  contact.begin_step(cloths, kFrame);
  move(cloths[1], {0, 0, -0.1}, kFrame);
  const Particles<float> before = cloths[1].particles();
  contact.end_step(cloths, kFrame);
  EXPECT_TRUE(same_state(cloths[1].particles(), before));
  EXPECT_EQ(contact.tangled_nodes(), 0);
  EXPECT_FALSE(contact.crowded(0));
}

// One that begins through another is tangled where they cross, and led apart, not kept in.
TEST(ClothContact, WhatBeginsEntangledIsTold) {
  std::vector<Cloth<float>> cloths = sheets({0, 0});
  Particles<float>& tilted = cloths[1].particles();
  each_node(tilted.grid(), [&](int r, int c) {
    const Vec3 place = get(tilted.position, r, c);
    set(tilted.position, r, c, {place.x(), place.y(), 0.2 * place.x()});
  });
  ClothContact<float> contact(ClothContactEffect{.thickness = kThickness});
  contact.begin_step(cloths, kFrame);
  EXPECT_GT(contact.tangled_nodes(), 0);
}

TEST(ClothContact, TellsHowFastClothGoesPastCloth) {
  std::vector<Cloth<float>> cloths = sheets({0, 0.012});
  const double speed = 3;
  move(cloths[1], {0, 0, 0}, kFrame);
  each_node(cloths[1].particles().grid(), [&](int r, int c) {
    set(cloths[1].particles().velocity, r, c, {speed, 0, 0});
  });
  ClothContact<float> contact(ClothContactEffect{.thickness = kThickness});
  contact.begin_step(cloths, kFrame);
  contact.end_step(cloths, kFrame);
  contact.begin_step(cloths, kFrame);
  // In cells of 1/16 m a second.
  EXPECT_NEAR(contact.cells_passed(), speed * 16, 0.05 * speed * 16);
}

using Groups = std::vector<std::vector<std::size_t>>;

// Of four, the first and the third lie on each other, and nothing lies near the second; the fourth is near
// the third, but its step is not made.
TEST(ClothContact, WhatTouchesIsSteppedTogether) {
  std::vector<Cloth<float>> cloths = sheets({0, 1, 0.006, 0.012});
  ClothContact<float> contact(ClothContactEffect{.thickness = kThickness});
  contact.begin_step(cloths, kFrame);
  contact.make_groups(cloths, {1, 1, 1, 0});
  EXPECT_EQ(contact.groups(), (Groups{{0, 2}, {1}, {3}}));
  contact.make_groups(cloths, {1, 1, 1, 1});
  EXPECT_EQ(contact.groups(), (Groups{{0, 2, 3}, {1}}));
}

TEST(ClothContact, ExplicitMethodsAreSteppedApart) {
  std::vector<Cloth<float>> cloths = sheets({0, 0.006});
  for (Cloth<float>& cloth : cloths) cloth.set_integrator(XpbdDescription{});
  ClothContact<float> contact(ClothContactEffect{.thickness = kThickness});
  contact.begin_step(cloths, kFrame);
  contact.make_groups(cloths, {1, 1});
  EXPECT_EQ(contact.groups(), (Groups{{0}, {1}}));
}

}  // namespace
}  // namespace weft::test
