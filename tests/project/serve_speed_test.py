#!/usr/bin/env python3
"""serve_speed_test.py TERRANE: how fast `terrane serve` sends a 20 kB tile, beside nginx.

wrk asks through 32 connections that are kept; 64 more lie idle. Where nginx itself does not reach the
figures, the machine is busy, and nginx's are what is asked for. Ends with 77 (skipped) where wrk or nginx
is missing.
"""

import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from hosting_test import NGINX, configuration, free_port

SKIPPED = 77
TILE_BYTES = 20_000
SECONDS = 4
IDLE = 64
FEWEST_REQUESTS_PER_S = 15_000
LONGEST_P99_MS = 20


def measure(port):
    """Requests a second, 99th percentile in ms."""
    done = subprocess.run(["wrk", "--threads", "1", "--connections", "32", "--duration",
                           f"{SECONDS}s", "--latency", f"http://127.0.0.1:{port}/tile.glb"],
                          capture_output=True, text=True, check=True)
    if "Non-2xx" in done.stdout or "Socket errors" in done.stdout:
        raise SystemExit(done.stdout)
    rate = float(re.search(r"Requests/sec:\s+([\d.]+)", done.stdout)[1])
    value, unit = re.search(r"99%\s+([\d.]+)(us|ms|s)", done.stdout).groups()
    return rate, float(value) * {"us": 0.001, "ms": 1, "s": 1000}[unit]


def idle_clients(port):
    clients = []
    for _ in range(IDLE):
        client = socket.create_connection(("127.0.0.1", port))
        client.sendall(b"GET /tile.glb HTTP/1.1\r\nHost: x\r\n\r\n")
        client.recv(1000)
        clients.append(client)
    return clients


def start_nginx(folder, tiles):
    port = free_port()
    (folder / "nginx.conf").write_text(configuration(folder, tiles, port))
    server = subprocess.Popen([NGINX, "-p", folder, "-c", folder / "nginx.conf"])
    time.sleep(0.5)
    return server, port


def start_terrane(terrane, tiles):
    server = subprocess.Popen([terrane, "--quiet", "serve", tiles, "--port", "0"],
                              stdout=subprocess.PIPE, text=True)
    return server, int(re.search(r":(\d+)/", server.stdout.readline())[1])


def main():
    if not shutil.which("wrk") or not NGINX:
        print("skipped: wrk or nginx is missing (scripts/setup --servers installs them)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        tiles = folder / "tiles"
        tiles.mkdir()
        (tiles / "tile.glb").write_bytes(os.urandom(TILE_BYTES))
        servers = []
        try:
            server, port = start_terrane(sys.argv[1], tiles)
            servers.append(server)
            idle = idle_clients(port)
            rate, p99_ms = measure(port)
            print(f"terrane serve, {IDLE} idle: {rate:.0f} requests/s, p99 {p99_ms:.2f} ms")
            for client in idle:
                client.close()
            nginx, nginx_port = start_nginx(folder, tiles)
            servers.append(nginx)
            nginx_rate, nginx_p99_ms = measure(nginx_port)
            print(f"nginx, one worker: {nginx_rate:.0f} requests/s, p99 {nginx_p99_ms:.2f} ms")
        finally:
            for server in servers:
                server.send_signal(signal.SIGTERM)
                server.wait(timeout=20)
    fewest = min(FEWEST_REQUESTS_PER_S, nginx_rate)
    longest_ms = max(LONGEST_P99_MS, nginx_p99_ms)
    if rate < fewest or p99_ms > longest_ms:
        print(f"wanted: {fewest:.0f} requests/s, p99 {longest_ms:.0f} ms")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
