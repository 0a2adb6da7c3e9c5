"""The AsyncAPI document of all messages (schema/asyncapi.json)."""
from .schema import pretty
from .table import BY, OPERATIONS, SPEC


def asyncapi():
    told = {message["op"]: message["summary"] for message in SPEC["server"]["messages"]}
    told.update({event["name"]: event["summary"] for event in SPEC["server"]["events"]})
    channel = {"$ref": "#/channels/scene"}

    def key(name):
        return name.replace(".", "_")

    def sent(names):
        return [{"$ref": f"#/channels/scene/messages/{key(name)}"} for name in names]

    def message(name, summary, file):
        return {"name": name, "title": name, "summary": summary, "contentType": "application/json",
                "payload": {"schemaFormat": "application/schema+json;version=draft-2020-12",
                            "schema": {"$ref": f"./{file}.schema.json#/$defs/{name}"}}}

    messages = {key(each["op"]): message(each["op"], each["summary"], "client") for each in OPERATIONS}
    messages.update({key(name): message(name, summary, "server") for name, summary in told.items()})
    messages["frame"] = {"name": "frame", "title": "frame",
                         "summary": "The newest state of one step as binary records: PROTOCOL.md section 4.",
                         "contentType": "application/octet-stream", "payload": {"type": "string", "format": "binary"}}
    operations = {
        key(each["op"]): {
            "action": "receive", "summary": each["summary"], "channel": channel, "messages": sent([each["op"]]),
            "reply": {"channel": channel, "messages": sent(["pong" if each["op"] == "ping" else "ok", "error"])}}
        for each in OPERATIONS}
    operations["tell"] = {"action": "send", "summary": "What the server says unasked.", "channel": channel,
                          "messages": sent(name for name in told if name not in ("ok", "error", "pong"))}
    operations["stream"] = {"action": "send", "summary": "The newest frame, at the level of this viewer.",
                            "channel": channel, "messages": sent(["frame"])}
    document = {
        "asyncapi": "3.0.0",
        "info": {
            "title": "Weft", "version": "1.0.0",
            "description": "A cloth simulation service: one WebSocket a viewer and scene. Control travels as JSON text "
                           "messages, meshes as binary messages. PROTOCOL.md is the contract; this document describes the "
                           f"same messages for tools. {BY}.",
            "license": {"name": "Apache-2.0"}},
        "defaultContentType": "application/json",
        "servers": {"local": {"host": "127.0.0.1:8080", "protocol": "ws",
                              "description": "weft serve with its default address"}},
        "channels": {"scene": {
            "address": "/v1/scenes/{name}", "title": "A scene",
            "description": "Upgrade with Sec-WebSocket-Protocol: weft.v1.", "servers": [{"$ref": "#/servers/local"}],
            "parameters": {"name": {"description": "The scene's name; GET /v1/scenes lists them."}},
            "messages": {name: {"$ref": f"#/components/messages/{name}"} for name in messages},
            "bindings": {"ws": {"method": "GET", "headers": {
                "type": "object", "properties": {"Sec-WebSocket-Protocol": {"const": "weft.v1"}},
                "required": ["Sec-WebSocket-Protocol"]}}}}},
        "operations": operations,
        "components": {"messages": messages}}
    return pretty(document) + "\n"
