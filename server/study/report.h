#pragma once
/// A study for people and for programs.
#include <string>

#include "study/study.h"

namespace weft::study {

/// What a report says about itself.
struct Heading {
  std::string scene;    ///< its name
  std::string title;    ///< its title
  std::string command;  ///< that made the study
  std::string machine;  ///< processor it was measured on
};

/// Plain text: for each level the reference, then every run from fast to slow, the best ones marked.
std::string table(const Study& study);

/// One line a run, with a header line; errors that do not exist and figures of runs not done are empty.
std::string csv(const Study& study, const Heading& heading);

/// One page that needs nothing else: a work-precision diagram a level and all figures.
std::string html(const Study& study, const Heading& heading);

/// How far a level's reference can be trusted, in one sentence.
std::string trust(const Study& study, const LevelStudy& level);

std::string_view name_of(Run::Status status);

}  // namespace weft::study
