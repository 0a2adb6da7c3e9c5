#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace weft {

/// What the library throws: its text names the value and the allowed range.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A scene that cannot be simulated, with all that is wrong with it.
class SceneError : public Error {
 public:
  struct Problem {
    std::string path;  ///< JSON pointer, for example "/cloths/0/material/density"; empty: the whole document
    std::string message;  ///< names the value and the allowed range
  };
  SceneError(const std::string& text, std::vector<Problem> problems)
      : Error(text), problems_(std::move(problems)) {}
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace weft
