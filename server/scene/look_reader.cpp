#include <algorithm>
#include <array>
#include <initializer_list>

#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr Range kThread{1e-4, 0.1, "m"};

constexpr std::initializer_list<const char*> kWeaves{"plain", "twill", "satin",   "canvas",
                                                     "wool",  "knit",  "leather", "paper"};

/// What a weave looks like where the scene does not say, and which fabric is woven so.
struct Default {
  std::string_view fabric;  ///< of weft::fabrics(); empty: of none
  std::string_view weave;
  const char* colour;
  const char* weft;
  double thread;  // m
};

/// The threads are thicker than real ones, so that they show. Of a weave that stands twice, the first is
/// meant.
constexpr std::array<Default, 10> kDefaults{{
    {"silk", "satin", "#b3263c", "#b3263c", 0.001},
    {"cotton", "plain", "#e9e4d8", "#e9e4d8", 0.002},
    {"canvas", "canvas", "#cdbf9f", "#cdbf9f", 0.004},
    {"denim", "twill", "#24406e", "#c9cdd3", 0.003},
    {"wool", "wool", "#6d6258", "#6d6258", 0.006},
    {"polyester", "plain", "#7d97ad", "#7d97ad", 0.002},
    {"stretch_wool", "twill", "#3d4048", "#5a5e68", 0.003},
    {"", "knit", "#8f3f3a", "#8f3f3a", 0.012},
    {"", "leather", "#7a4a2a", "#7a4a2a", 0.008},
    {"", "paper", "#f4f1e8", "#f4f1e8", 0.002},
}};

const Default* default_where(std::string_view Default::*member, std::string_view name) {
  return std::find_if(kDefaults.begin(), kDefaults.end(),
                      [&](const Default& each) { return each.*member == name; });
}

/// Of a cloth of no named fabric and without a look.
Look nameless() {
  constexpr double kWide = 0.006;  // m
  return {"plain", "#2c5894", "#4674b0", "", kWide, Stripe{"#f6ecd6", 14 * kWide, 64 * kWide, 3, false}};
}

Look look_of(const Default& from) { return {from.weave, from.colour, from.weft, "", from.thread, {}}; }

/// The name of the fabric that a material is of, or begins with; empty: none.
std::string_view fabric_of(const json* material) {
  if (material && material->is_object()) {
    const auto named = material->find("fabric");
    material = named == material->end() ? nullptr : &*named;
  }
  return material && material->is_string() ? std::string_view(material->get_ref<const std::string&>()) : "";
}

bool is_colour(const json& value) {
  constexpr std::size_t kLength = 7;
  if (!value.is_string()) return false;
  const auto& text = value.get_ref<const std::string&>();
  return text.size() == kLength && text[0] == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
}

bool read_colour(Object& object, const char* key, std::string& target) {
  const json* value = object.find(key);
  if (!value) return false;
  if (!is_colour(*value)) {
    object.report().refuse(*value, object.path(key), "a colour, \"#rrggbb\" in hexadecimal digits");
    return false;
  }
  target = value->get<std::string>();
  return true;
}

Stripe read_stripe(const json& value, const std::string& path, Report& report, double thread) {
  constexpr Range kBands{1, 3};
  constexpr double kFewest = 4,
                   kMost = 256;  // threads from stripe to stripe: what a picture of the page can show
  Stripe stripe;
  Object object(value, path, report);
  const Range spacing{kFewest * thread, kMost * thread, "m"};
  object.require("colour", "a colour, \"#rrggbb\" in hexadecimal digits");
  read_colour(object, "colour", stripe.colour);
  object.require("spacing", spacing);
  if (object.number("spacing", stripe.spacing, spacing)) {
    stripe.width = stripe.spacing / 2;
    object.number("width", stripe.width, {thread, stripe.spacing, "m"});
  } else {
    object.find("width");
  }
  object.integer("bands", stripe.bands, kBands);
  object.boolean("across", stripe.across);
  return stripe;
}

}  // namespace

Look read_look(const json* value, const std::string& path, Report& report, const json* material) {
  const std::string_view fabric = fabric_of(material);
  const auto* own = fabric.empty() ? kDefaults.end() : default_where(&Default::fabric, fabric);
  const bool named = own != kDefaults.end();
  Look look = named ? look_of(*own) : nameless();
  if (!value) return look;

  Object object(*value, path, report);
  look.stripe.reset();
  const int weave = object.choice("weave", kWeaves);
  if (weave >= 0 && look.weave != kWeaves.begin()[weave])
    look = look_of(*default_where(&Default::weave, kWeaves.begin()[weave]));
  const bool two_tone = look.weave == "twill";
  const bool coloured = read_colour(object, "colour", look.colour);
  if (!read_colour(object, "weft", look.weft) && coloured && !two_tone) look.weft = look.colour;
  read_colour(object, "back", look.back);
  object.number("thread", look.thread, kThread);
  if (const json* stripe = object.find("stripe"))
    look.stripe = read_stripe(*stripe, object.path("stripe"), report, look.thread);
  return look;
}

}  // namespace weft::scene
