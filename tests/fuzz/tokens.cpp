#include <stdexcept>

#include "memory_file.h"
#include "net/access.h"
#include "targets.h"

namespace weft::fuzz {

// A file is taken whole or refused by its name.
void tokens(Input input) {
  const MemoryFile file(input);
  try {
    const net::Access access = net::Access::read(file.path());
    access.role_of(std::nullopt);
    access.role_of("a-token-of-nobody");
  } catch (const std::runtime_error& error) {
    require(std::string(error.what()).find(file.path()) != std::string::npos, "a refusal names the file");
  }
}

}  // namespace weft::fuzz
