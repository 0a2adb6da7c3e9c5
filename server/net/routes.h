#pragma once
/// What a request asks for, and whether who sends it may have it. HttpSession brings it about.
#include <memory>
#include <string>
#include <variant>

#include "net/answers.h"
#include "net/request_rules.h"

namespace weft::net {

/// What a request does not say of itself.
struct Caller {
  bool must_be_secure = false;       ///< may show no token as it is connected
  NoPlace no_place = NoPlace::none;  ///< why it has none
  bool sent_more = false;            ///< before this request was answered
};

/// PUT of a scene: what its description, the body that is still to be read, is to be called.
struct SceneToMake {
  std::string name;
};

/// An upgrade that may be made: a place in the scene is reserved for its viewer.
struct SceneToOpen {
  std::shared_ptr<host::SceneRunner> scene;
  protocol::Role role;
};

using Outcome = std::variant<Answer, SceneToMake, SceneToOpen>;

/// Ends the scene that a DELETE names. Of `request` lists are joined (join_lists).
Outcome outcome_of(Context& context, const HttpRequest& request, const Caller& caller);

}  // namespace weft::net
