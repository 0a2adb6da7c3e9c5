#pragma once
/// How a state is written down and read again: bytes as they are in memory, by cereal, which knows the
/// containers. A class says what its state is in one member, serialize(archive), for both.
#include <cereal/cereal.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/variant.hpp>
#include <cereal/types/vector.hpp>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "cloth/core/vec3.h"

namespace weft {

/// What is read is no state, or one of something else.
struct BadState : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class StateWriter : public cereal::OutputArchive<StateWriter, cereal::AllowEmptyClassElision> {
 public:
  explicit StateWriter(std::string& bytes)
      : cereal::OutputArchive<StateWriter, cereal::AllowEmptyClassElision>(this), bytes_(bytes) {}
  void write(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }

 private:
  std::string& bytes_;
};

/// Throws BadState where the bytes end too early; takes no more memory than they can fill.
class StateReader : public cereal::InputArchive<StateReader, cereal::AllowEmptyClassElision> {
 public:
  explicit StateReader(std::string_view bytes)
      : cereal::InputArchive<StateReader, cereal::AllowEmptyClassElision>(this), rest_(bytes) {}
  void read(void* data, std::size_t size) {
    if (size > rest_.size()) throw BadState("the state ends too early");
    if (size == 0) return;  // an empty list has no address
    std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  std::size_t rest() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

template <class T, std::enable_if_t<std::is_arithmetic_v<T>, int> = 0>
void CEREAL_SAVE_FUNCTION_NAME(StateWriter& archive, const T& value) {
  archive.write(&value, sizeof value);
}
template <class T, std::enable_if_t<std::is_arithmetic_v<T>, int> = 0>
void CEREAL_LOAD_FUNCTION_NAME(StateReader& archive, T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    // To look at a bool that is neither true nor false is undefined.
    unsigned char byte = 0;
    static_assert(sizeof byte == sizeof value);
    archive.read(&byte, sizeof byte);
    if (byte > 1) throw BadState("the state has a yes or no that is neither");
    value = byte == 1;
  } else {
    archive.read(&value, sizeof value);
  }
}
template <class T>
void CEREAL_SAVE_FUNCTION_NAME(StateWriter& archive, const cereal::NameValuePair<T>& named) {
  archive(named.value);
}
template <class T>
void CEREAL_LOAD_FUNCTION_NAME(StateReader& archive, cereal::NameValuePair<T>& named) {
  archive(named.value);
}
template <class T>
void CEREAL_SAVE_FUNCTION_NAME(StateWriter& archive, const cereal::BinaryData<T>& data) {
  archive.write(data.data, data.size);
}
template <class T>
void CEREAL_LOAD_FUNCTION_NAME(StateReader& archive, cereal::BinaryData<T>& data) {
  archive.read(data.data, data.size);
}
template <class T>
void CEREAL_SAVE_FUNCTION_NAME(StateWriter& archive, const cereal::SizeTag<T>& tag) {
  archive(tag.size);
}
/// Each element has a byte or more.
template <class T>
void CEREAL_LOAD_FUNCTION_NAME(StateReader& archive, cereal::SizeTag<T>& tag) {
  archive(tag.size);
  if (tag.size > archive.rest()) throw BadState("the state has a list that is longer than the state");
}

}  // namespace weft

namespace cereal {

template <class Archive, int kRows, int kCols>
void serialize(Archive& archive, Eigen::Matrix<double, kRows, kCols>& matrix) {
  for (int i = 0; i < kRows * kCols; ++i) archive(matrix.data()[i]);
}
template <class Archive>
void serialize(Archive& archive, Eigen::Quaterniond& quaternion) {
  archive(quaternion.coeffs());
}
template <class Archive>
void serialize(Archive& archive, Eigen::AlignedBox3d& box) {
  archive(box.min(), box.max());
}

}  // namespace cereal

CEREAL_SETUP_ARCHIVE_TRAITS(weft::StateReader, weft::StateWriter)
