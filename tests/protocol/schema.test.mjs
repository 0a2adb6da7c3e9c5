// The JSON Schemas and the hand-written checks agree on the shared vectors; the AsyncAPI document names every message.
import assert from 'node:assert/strict';
import { test } from 'node:test';

import Ajv from 'ajv/dist/2020.js';

import { loadJson, messages, serverMessages } from './vectors.mjs';

const clientSchema = loadJson('schema/client.schema.json'), serverSchema = loadJson('schema/server.schema.json');
// `required` of members that stand beside a oneOf, and bounds beside a $ref, are meant: strict mode's other checks stay on.
const ajv = new Ajv.default({ strict: true, strictRequired: false, strictTypes: false });
const client = ajv.compile(clientSchema), server = ajv.compile(serverSchema);

for (const { text } of messages.good)
  test(`schema takes ${text}`, () => assert.ok(client(JSON.parse(text)), ajv.errorsText(client.errors)));

for (const vector of messages.bad.filter(({ text_only: textOnly }) => !textOnly))
  test(`schema refuses ${vector.text}`, () => assert.equal(client(JSON.parse(vector.text)), false));

for (const message of serverMessages.good)
  test(`schema takes ${JSON.stringify(message).slice(0, 60)}`, () => assert.ok(server(message), ajv.errorsText(server.errors)));

for (const { about, message } of serverMessages.bad)
  test(`schema refuses a server message: ${about}`, () => assert.equal(server(message), false));

test('the vectors have every operation, every server message and every error code of the schemas', () => {
  const sent = new Set(messages.good.map(({ op }) => op));
  assert.deepEqual([...sent].sort(), [...clientSchema.properties.op.enum].sort());
  const received = new Set(serverMessages.good.map(({ op }) => op));
  assert.deepEqual([...received].sort(), [...serverSchema.properties.op.enum].sort());
  const parsing = ['bad_json', 'bad_type', 'unknown_op', 'missing', 'unknown_member', 'range', 'conflict'];
  assert.deepEqual([...new Set(messages.bad.map(({ code }) => code))].sort(), parsing.sort());
});

const asyncapi = loadJson('schema/asyncapi.json');
const files = { '': asyncapi, './client.schema.json': clientSchema, './server.schema.json': serverSchema };

function resolve(reference) {
  const [file, pointer] = reference.split('#');
  const parts = pointer.split('/').slice(1).map((part) => part.replaceAll('~1', '/').replaceAll('~0', '~'));
  return parts.reduce((value, part) => value?.[part], files[file]);
}

function references(value) {
  if (value === null || typeof value !== 'object') return [];
  return Object.entries(value).flatMap(([name, inner]) => (name === '$ref' ? [inner] : references(inner)));
}

test('every reference of the AsyncAPI document leads somewhere', () => {
  const all = references(asyncapi);
  assert.ok(all.length > 100);
  for (const reference of all) assert.notEqual(resolve(reference), undefined, reference);
});

test('the AsyncAPI document has every operation and message of the schemas', () => {
  assert.equal(asyncapi.asyncapi, '3.0.0');
  const schemas = Object.values(asyncapi.components.messages).map(({ payload }) => payload.schema?.$ref).filter(Boolean);
  const wanted = [clientSchema, serverSchema].flatMap((schema) => schema.oneOf.map(({ $ref }) => `./${schema.$id}${$ref}`));
  assert.deepEqual(schemas.sort(), wanted.sort());
  for (const op of clientSchema.properties.op.enum) assert.ok(asyncapi.operations[op.replaceAll('.', '_')], op);
});
