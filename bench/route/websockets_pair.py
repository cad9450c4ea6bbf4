# SPDX-License-Identifier: MIT
"""One half of a pair that carries datagrams through a WebSocket, by Python's websockets: each datagram is a message.

  websockets_pair.py in UDP_PORT WS_PORT     from UDP to a server
  websockets_pair.py out WS_PORT UDP_PORT    from clients to UDP"""
import asyncio
import socket
import sys

from websockets.asyncio.client import connect
from websockets.asyncio.server import serve

HOST = "127.0.0.1"


async def datagrams_in(udp_port, ws_port):
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 32 << 20)
    sock.bind((HOST, udp_port))
    sock.setblocking(False)
    loop = asyncio.get_running_loop()
    async for client in connect(f"ws://{HOST}:{ws_port}", compression=None):
        while True:
            await client.send(await loop.sock_recv(sock, 65536))


async def datagrams_out(ws_port, udp_port):
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.connect((HOST, udp_port))

    async def handle(client):
        async for message in client:
            sock.send(message)
    async with serve(handle, HOST, ws_port, compression=None) as server:
        await server.serve_forever()


if __name__ == "__main__":
    run = datagrams_in if sys.argv[1] == "in" else datagrams_out
    asyncio.run(run(int(sys.argv[2]), int(sys.argv[3])))
