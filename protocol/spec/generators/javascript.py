"""The JavaScript client's methods (clients/js/commands.js)."""
import json
import textwrap

from .table import BY, camel, described, is_required, members_of, methods, told

HEAD = f"""/** A method for each operation of PROTOCOL.md section 2. {BY}. */
import {{ WeftError }} from './errors.js';

/** @typedef {{import('./types.js').Vector}} Vector */

/** The methods, whatever carries them: who extends it sends. */
export class Commands {{
  /**
   * Sends a request and gives its `ok` or `pong`.
   * @param {{string}} op @param {{Record<string, any>}} [members] @returns {{Promise<any>}}
   */
  send(op, members) {{
    throw new WeftError('closed', `nothing carries ${{op}}, ${{JSON.stringify(members)}}`);
  }}

"""


def javascript_commands():
    return HEAD + "\n\n".join(map(javascript_method, methods("js"))) + "\n}\n"


def javascript_method(operation):
    members = members_of(operation)
    positional = [member for member in members if is_required(member) or member.get("positional")]
    options = [member for member in members if member not in positional]
    doc = textwrap.wrap(described(operation, operation["client"].get("returns")), 112, break_long_words=False, break_on_hyphens=False)
    for member in positional:
        name = camel(member["name"]) if is_required(member) else f"[{camel(member['name'])}]"
        doc.append(f"@param {{{member['js']}}} {name} {told(member)}".rstrip())
    if options:
        kinds = ", ".join(f"{camel(member['name'])}?: {member['js']}" for member in options)
        notes = "; ".join(f"{camel(member['name'])}: {told(member)}" for member in options if told(member))
        doc.append(f"@param {{{{{kinds}}}}} [options] {notes}".rstrip())
    returns = operation["client"].get("returns")
    ok = operation.get("ok", {})
    if returns:
        doc.append(f"@returns {{Promise<{operation['client']['js']}>}} {ok[returns] if len(ok[returns]) < 30 else ''}".rstrip())
    arguments = [camel(member["name"]) + ("" if is_required(member) else f" = {json.dumps(member['default'])}")
                 for member in positional]
    if options:
        arguments.append("{ " + ", ".join(camel(member["name"]) for member in options) + " } = {}")
    sent = ", ".join(member["name"] if camel(member["name"]) == member["name"] else f"{member['name']}: {camel(member['name'])}"
                     for member in members)
    call = f"this.send('{operation['op']}'" + (f", {{ {sent} }})" if members else ")")
    comment = (f"  /** {doc[0]} */" if len(doc) == 1 else
               "\n".join(["  /**"] + [f"   * {line}" for line in doc] + ["   */"]))
    head = f"  {'async ' if returns else ''}{camel(operation['client']['name'])}({', '.join(arguments)}) {{"
    body = f"    return (await {call}).{returns};" if returns else f"    return {call};"
    return "\n".join([comment, head, body, "  }"])
