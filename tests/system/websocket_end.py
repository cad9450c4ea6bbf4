# SPDX-License-Identifier: MIT
"""The far end of a wsin or wsout, by wsproto (its WebSocket without sockets), for the tests of routers."""
import socket

import harness
from routers import TcpEnd
from wsproto import ConnectionType, WSConnection
from wsproto.events import AcceptConnection, BytesMessage, CloseConnection, Ping, Request


class WebSocketEnd(TcpEnd):
    """`sock` is connected; `kind` states which end sends the handshake."""

    def __init__(self, sock, label, kind):
        super().__init__(sock, label)
        self.sock.settimeout(harness.DEFAULT_TIMEOUT_S)
        self.connection = WSConnection(kind)
        if kind is ConnectionType.CLIENT:
            self.sock.sendall(self.connection.send(Request(host="127.0.0.1", target="/")))
        self.is_open = False
        while not self.is_open:
            self._partial += self._read()

    def send(self, data):
        self.sock.sendall(self.connection.send(BytesMessage(data=data)))

    def _read(self):
        self.connection.receive_data(super()._read())
        return b"".join(self._handle(event) for event in self.connection.events())

    def _handle(self, event) -> bytes:
        assert not isinstance(event, CloseConnection), "the router closed the connection"
        if isinstance(event, Request):
            self.sock.sendall(self.connection.send(AcceptConnection()))
        if isinstance(event, Ping):
            self.sock.sendall(self.connection.send(event.response()))
        self.is_open = self.is_open or isinstance(event, (Request, AcceptConnection))
        return bytes(event.data) if isinstance(event, BytesMessage) else b""


def client(port, label=None) -> WebSocketEnd:
    sock = socket.create_connection(("127.0.0.1", port), timeout=harness.DEFAULT_TIMEOUT_S)
    return WebSocketEnd(sock, label, ConnectionType.CLIENT)


def accepted(server, label=None) -> WebSocketEnd:
    return WebSocketEnd(server.accept()[0], label, ConnectionType.SERVER)
