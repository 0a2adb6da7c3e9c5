#include "protocol/command_reader.h"

#include <algorithm>
#include <utility>

#include "protocol/operation.h"

namespace weft::protocol {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

template <class Items>
std::string listed(const Items& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + std::string(item.name);
  return text;
}

}  // namespace

std::optional<JsonFault> read_command(const json& message, Request& request) {
  if (!message.is_object())
    return JsonFault{"bad_type", "", "the message is " + shown(message) + "; allowed: an object with op"};
  if (const auto id = message.find("id"); id != message.end()) {
    constexpr Bounds kRequestId{1, 2147483647};
    if (auto fault = read(*id, kRequestId, "/id", request.id.emplace())) return fault;
  }

  const auto op = message.find("op");
  if (op == message.end())
    return JsonFault{"missing", "/op", "/op is missing; allowed: " + listed(operations())};
  if (!op->is_string()) return refuse("bad_type", "/op", *op, listed(operations()));
  const auto operation = std::find_if(operations().begin(), operations().end(),
                                      [&](const Operation& known) { return *op == known.name; });
  if (operation == operations().end()) return refuse("unknown_op", "/op", *op, listed(operations()));

  for (const auto& member : message.items()) {
    const std::string& name = member.key();
    const bool known = name == "op" || name == "id" ||
                       std::any_of(operation->fields.begin(), operation->fields.end(),
                                   [&](const Field& field) { return name == field.name; });
    if (!known) {
      const std::string also = operation->fields.empty() ? "" : ", " + listed(operation->fields);
      return refuse("unknown_member", pointer_to("", name), member.value(),
                    std::string("in ") + operation->name + " only op, id" + also);
    }
  }

  request.command = operation->blank;
  for (const Field& field : operation->fields) {
    const auto value = message.find(field.name);
    if (value != message.end()) {
      if (auto fault = field.read_into(field, *value, request.command)) return fault;
    } else if (field.presence == Presence::required) {
      const std::string path = pointer_to("", field.name);
      return JsonFault{"missing", path, path + " is missing; allowed: " + field.kind(field.bounds)};
    }
  }
  return operation->finish != nullptr ? operation->finish(message, request.command) : Fault{};
}

void write_command(const Request& request, ordered_json& message) {
  const Operation& operation = operations()[request.command.index()];
  message["op"] = operation.name;
  if (request.id) message["id"] = *request.id;
  for (const Field& field : operation.fields) {
    ordered_json value;
    field.write_from(request.command, value);
    if (!value.is_null()) message[field.name] = std::move(value);
  }
}

}  // namespace weft::protocol
