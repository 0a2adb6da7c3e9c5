// PROTOCOL.md: its examples are messages that the schema takes, and it has a section for each operation.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import Ajv from 'ajv/dist/2020.js';

import { loadJson } from './vectors.mjs';

const document = readFileSync(new URL('../../protocol/PROTOCOL.md', import.meta.url), 'utf8');
const schema = loadJson('schema/client.schema.json');
const ajv = new Ajv.default({ strict: true, strictRequired: false, strictTypes: false });
const valid = ajv.compile(schema);
const examples = [...document.matchAll(/^```json\n([^]*?)^```$/gm)].flatMap(([, block]) => block.trim().split('\n'));

for (const example of examples)
  test(`the schema takes ${example}`, () => assert.ok(valid(JSON.parse(example)), ajv.errorsText(valid.errors)));

test('each operation has a section and an example', () => {
  const operations = [...schema.properties.op.enum].sort();
  const sections = [...document.matchAll(/^#### (.*)$/gm)].flatMap(([, title]) => [...title.matchAll(/`([a-z.]+)`/g)].map(([, op]) => op));
  assert.deepEqual(sections.sort(), operations);
  assert.deepEqual([...new Set(examples.map((example) => JSON.parse(example).op))].sort(), operations);
});
