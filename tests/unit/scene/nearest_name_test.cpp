/// Which name was meant: by the fewest characters that differ, or as a part.
#include "scene/nearest_name.h"

#include <gtest/gtest.h>

namespace weft::scene {
namespace {

const std::vector<std::string_view> kNames{"gravity", "damping", "cloth_contact", "size", "sewn"};

TEST(NearestName, HasTheFewestEdits) {
  EXPECT_EQ(nearest_name("gravty", kNames), "gravity");    // one left out
  EXPECT_EQ(nearest_name("gravitty", kNames), "gravity");  // one added
  EXPECT_EQ(nearest_name("dumping", kNames), "damping");   // one changed
  EXPECT_EQ(nearest_name("garvity", kNames), "gravity");   // two swapped
  EXPECT_EQ(nearest_name("Size", kNames), "size");         // case says nothing
  EXPECT_EQ(nearest_name("cloth-contact", kNames), "cloth_contact");
}

TEST(NearestName, MayBeAPartOrTheWhole) {
  EXPECT_EQ(nearest_name("contact", kNames), "cloth_contact");
  EXPECT_EQ(nearest_name("gravity_acceleration", kNames), "gravity");
  EXPECT_EQ(nearest_name("contact", {"cloth_contact", "body_contact"}), "")
      << "which of the two is not known";
}

TEST(NearestName, IsNoneWhereNoneIsNear) {
  EXPECT_EQ(nearest_name("colour", kNames), "");
  EXPECT_EQ(nearest_name("", kNames), "");
  EXPECT_EQ(nearest_name("size", kNames), "") << "it is one";
  EXPECT_EQ(nearest_name(std::string(100'000, 'g'), kNames), "");
  EXPECT_EQ(nearest_name("gravty", {}), "");
}

/// The time grows with the product of the lengths; one of 64 characters is compared, one of 65 is not.
TEST(NearestName, LooksNoFurtherThan64Characters) {
  const std::string name(64, 'g');
  EXPECT_EQ(nearest_name(std::string(63, 'g') + 'x', {name}), name);
  EXPECT_EQ(nearest_name(std::string(64, 'g') + 'x', {name}), "");
}

TEST(NearestName, IsAskedAfter) {
  EXPECT_EQ(did_you_mean("gravty", kNames), "; did you mean \"gravity\"?");
  EXPECT_EQ(did_you_mean("colour", kNames), "");
}

}  // namespace
}  // namespace weft::scene
