"""Weft client: the protocol of PROTOCOL.md (weft.v1) for Python 3.9 and later.

    import weft

    with weft.open("ws://127.0.0.1:8080/v1/scenes/flag") as scene:
        scene.camera(distance=5)
        ball = scene.add_ball([0, 1, 2], radius=0.2)
        scene.throw_ball(ball, [0, 0, -6])
        for frame in scene:                                # the newest one each time
            print(frame.stamp.f, frame.cloths[0].positions.mean(axis=(0, 1)))

For asyncio the same with `async with await weft.connect(...)`, `await` before each method, and `async for`.
"""
from .client import Client, connect
from .errors import WeftError
from .export import write_glb, write_npz, write_obj
from .frames import decode_frame
from .messages import message_text
from .sync import Scene, open
from .transport import MAX_MESSAGE_BYTES, SUBPROTOCOL, backoff
from .types import Ball, Cloth, Frame, Message, MovedObstacle, Stamp, Turn, Vector

__all__ = ["Ball", "Client", "Cloth", "Frame", "MAX_MESSAGE_BYTES", "Message", "MovedObstacle", "SUBPROTOCOL", "Scene", "Stamp",
           "Turn", "Vector", "WeftError", "backoff", "connect", "decode_frame", "message_text", "open",
           "write_glb", "write_npz", "write_obj"]
