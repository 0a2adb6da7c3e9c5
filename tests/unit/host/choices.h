#pragma once
/// Choices made by hand: what a study might have found.
#include "study/quality.h"

namespace weft::host::test {

/// At each level L of 4, 5 and 6 three of xpbd's settings, which take 1, 2 and 4 times 4^(L - 4) ms with
/// errors of 0.1, 0.01 and 0.001, over 10, 10 and 2 s; the scene's own takes as long as the dearest and is as
/// bad as the cheapest.
inline study::Choices three_levels() {
  study::Choices choices;
  choices.frames = 30;
  double base = 1;
  for (const int level : {4, 5, 6}) {
    study::LevelChoices& of_level = choices.levels.emplace_back();
    of_level.level = level;
    of_level.space = 0.02 / base;
    of_level.front = {{level, XpbdDescription{5}, base, 0.1, 10},
                      {level, XpbdDescription{10}, 2 * base, 0.01, 10},
                      {level, XpbdDescription{20}, 4 * base, 0.001, 2}};
    of_level.own = study::Choice{level, Bdf2Description{}, 4 * base, 0.1, 10};
    of_level.all = of_level.front;
    of_level.all.push_back(*of_level.own);
    base *= 4;
  }
  return choices;
}

}  // namespace weft::host::test
