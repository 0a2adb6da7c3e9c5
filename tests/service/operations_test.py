"""Random valid operations of every kind that operations.json has, from several clients at once: each is answered, with `ok` or one
of the errors that the table lets it have, and the server goes on. WEFT_OPERATIONS says how many, WEFT_SEED which."""
import asyncio
import collections
import json
import os
import random
import signal
import time
import unittest

from serving import GENEROUS, ROOT, SCENES, Server

import weft

OPERATIONS = int(os.environ.get("WEFT_OPERATIONS", 4000))
SEED = int(os.environ.get("WEFT_SEED", time.time()))
CLIENTS, AT_ONCE = 4, 50
WAIT = 20 * GENEROUS  # s, for an answer: steps are slow under a sanitizer, and 50 operations may each cost one much
TABLE = json.loads((ROOT / "protocol" / "spec" / "operations.json").read_text())
TYPES, TABLE = TABLE["types"], {operation["op"]: operation for group in TABLE["groups"] for operation in group["operations"]}
# What any command may be answered with: more than a scene's queue holds, more than a viewer may send.
ALWAYS = {"limit", "rate"}


class Draw:
    """Draws valid operations for a scene as its `scene` message told it."""

    def __init__(self, chance, scene):
        self.chance, self.scene, self.seat = chance, scene, scene["seat"]
        self.ids = collections.defaultdict(lambda: collections.deque(maxlen=8))  # balls and grabs, as answers named them

    def operation(self):
        op = self.chance.choice(sorted(TABLE))
        given = {member["name"]: member for member in TABLE[op].get("members", []) if self.given(member)}
        for rule in TABLE[op].get("rules", []):
            self.keep(rule, given, TABLE[op])
        return op, {name: self.value(op, member) for name, member in given.items()}

    def given(self, member):
        needed = "default" not in member and not member.get("optional")
        return needed or self.chance.random() < 0.5

    def keep(self, rule, given, operation):
        """Gives and takes members until the rule holds."""
        members = {member["name"]: member for member in operation.get("members", [])}
        for name in ("exactly_one", "at_most_one"):
            chosen = self.chance.choice(rule.get(name, [None]))
            for each in rule.get(name, []):
                if each != chosen:
                    given.pop(each, None)
            if name == "exactly_one" and name in rule:
                given[chosen] = members[chosen]
        for each in rule.get("members", []):
            if rule["beside"] not in given:
                given.pop(each, None)
        together = rule.get("together", [])
        if any(each in given for each in together) and not all(each in given for each in together):
            for each in together:
                given.pop(each, None)

    def value(self, op, member):
        kind, name = member["type"], member["name"]
        low, high = member.get("range", TYPES[kind].get("range", (0, 1)))
        draw = {
            "text": lambda: self.text(op, name), "texts": lambda: self.chance.sample(["flow.level", "grid.rice", "another"], 2),
            "flag": lambda: self.chance.random() < 0.7, "motion": lambda: self.chance.choice(["kinematic", "dynamic"]),
            "count": lambda: self.chance.randint(low, min(high, 8)), "uint32": lambda: self.chance.randint(0, 2),
            "ball": lambda: self.known("ball"), "grab": lambda: self.known("grab"), "cloth": lambda: self.chance.choice([0, 0, 0, 7]),
            "obstacle": lambda: self.chance.choice([0, 1, 1, 1, 7]), "parameters": lambda: self.parameters(op),
            "turn": lambda: [self.number(low, high) or 1 for _ in range(4)],
        }
        for triple in ("vector", "eye", "place", "velocity"):
            draw[triple] = lambda: [self.number(low, high) or 1 for _ in range(3)]
        return draw.get(kind, lambda: self.number(low, high))()

    def number(self, low, high):
        """Most often of the size that scenes have, sometimes anything that is allowed."""
        if self.chance.random() < 0.95:
            low, high = max(low, -2), min(high, 2)
        return self.chance.choice([low, high]) if self.chance.random() < 0.05 else self.chance.uniform(low, high)

    def known(self, kind):
        return self.chance.choice(list(self.ids[kind]) or [0]) if self.chance.random() < 0.9 else self.chance.randint(0, 2**32 - 1)

    def text(self, op, name):
        return {"scene": lambda: self.chance.choice(["everything", "hung"]), "effect": lambda: self.chance.choice(self.scene["effects"]),
                "seat": lambda: self.seat}.get(name, lambda: "someone")()

    def parameters(self, op):
        """What may be tuned of something in the scene, in its range; of the cloth or the effect named, or it is refused."""
        of = self.scene["material_tunable"] if op == "cloth.tune" else self.scene["tunable"][self.chance.choice(sorted(self.scene["tunable"]))]
        name = self.chance.choice(sorted(of))
        shape = next((values[name] for values in self.scene.get("parameters", {}).values() if name in values), 0)
        low, high = of[name]["range"]
        return {name: [self.number(low, high) for _ in shape] if isinstance(shape, list) else self.number(low, high)}

    def learn(self, answer):
        for kind in ("ball", "grab"):
            if kind in answer:
                self.ids[kind].append(answer[kind])


class Operations(unittest.IsolatedAsyncioTestCase):
    async def test_each_is_answered_and_the_server_goes_on(self):
        print(f"{OPERATIONS} operations, seed {SEED}")
        self.accepted, self.refused = collections.Counter(), collections.Counter()
        with Server(SCENES / "everything.json", SCENES / "hung.json", "--messages-per-second", 100000) as server:
            await asyncio.gather(*[self.client(server, random.Random(SEED + i), OPERATIONS // CLIENTS) for i in range(CLIENTS)])
            async with await weft.connect(server.url("everything"), timeout=WAIT) as viewer:
                await viewer.reset()
                await viewer.resume()
                stamp = (await viewer.next_frame(timeout=WAIT)).stamp
                await viewer.next_frame(lambda frame: frame.stamp.f > stamp.f or frame.stamp.epoch > stamp.epoch, timeout=WAIT)
            server.terminate(signal.SIGTERM)
            self.assertEqual(server.process.wait(WAIT), 0)
            self.assertFalse([line for line in server.log_lines if " error " in line], server.log_lines)
        print("accepted", dict(self.accepted), "refused", dict(self.refused))
        kinds = set(TABLE) - {"ack"}  # which nothing answers but an error
        if OPERATIONS >= 4000:
            # A seat that nobody left is refused; all others are carried out at times.
            self.assertLessEqual(kinds - {"seat.resume"}, {op for op in self.accepted})

    async def client(self, server, chance, count):
        async with await weft.connect(server.url("everything"), window=0, timeout=WAIT) as client:
            draw = Draw(chance, client.scene)
            watching = asyncio.create_task(self.watch(client))
            for start in range(0, count, AT_ONCE):
                await asyncio.gather(*[self.give(client, draw) for _ in range(min(AT_ONCE, count - start))])
            watching.cancel()

    @staticmethod
    async def watch(client):
        async for _ in client:
            pass

    async def give(self, client, draw):
        op, members = draw.operation()
        if op == "ack":
            return await client.post(op, **members)
        try:
            answer = await client.send(op, **members)
        except weft.WeftError as error:
            declared = {each.split(",")[0] for each in TABLE[op].get("errors") or []}
            self.assertIn(error.code, declared | ALWAYS, f"{op} {members}: {error}")
            self.refused[f"{op} {error.code}"] += 1
        else:
            draw.scene = client.scene
            draw.learn(answer)
            self.accepted[op] += 1


if __name__ == "__main__":
    unittest.main()
