#!/usr/bin/env python3
"""Runs nginx with the configuration of docs/hosting.md, and asks it what clients ask.

Ends with 77 (skipped) where nginx is missing.
"""

import gzip
import http.client
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
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = 77
# Debian has it where only root looks
NGINX = shutil.which("nginx", path=os.environ["PATH"] + ":/usr/sbin:/usr/local/sbin")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def server_block():
    text = (ROOT / "docs/hosting.md").read_text(encoding="utf-8")
    return re.search(r"```nginx\n(.*?)```", text, re.S)[1]


def configuration(folder, root, port):
    server = server_block()
    for given, used in (("listen 80;", f"listen 127.0.0.1:{port};"), ("/srv/tiles", str(root))):
        assert given in server, f"docs/hosting.md has no '{given}'"
        server = server.replace(given, used)
    temporary = "\n".join(f"{kind}_temp_path {folder}/{kind};" for kind in
                          ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    user = "user root;" if os.geteuid() == 0 else ""  # the test's folder is nobody else's
    return (f"{user} daemon off; worker_processes 1; pid {folder}/pid; error_log {folder}/errors;\n"
            f"events {{}}\nhttp {{ access_log off; {temporary}\n{server} }}\n")


class Nginx(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.temporary.name)
        root = folder / "tiles"
        cls.json = b'{"asset": {"version": "1.1"}}' + b" " * 5000
        files = {"st/tileset.json": cls.json, "st/tiles/0/0/0.glb": b"glTF tile",
                 "st/layer.json": b"{}", "st/layer.json.gz": gzip.compress(b"{'beside': 1}"),
                 "st/0/0/0.terrain": gzip.compress(b"quantized mesh"),
                 "st.pmtiles": b"PMTiles archive", "st/.work/key": b"hidden"}
        for name, content in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_bytes(content)
        cls.port = free_port()
        (folder / "nginx.conf").write_text(configuration(folder, root, cls.port))
        cls.server = subprocess.Popen([NGINX, "-p", folder, "-c", folder / "nginx.conf"],
                                      stderr=subprocess.PIPE)
        cls.wait_until_it_answers()

    @classmethod
    def wait_until_it_answers(cls):
        for _ in range(100):
            if cls.server.poll() is not None:
                raise SystemExit(f"nginx ends at once: {cls.server.stderr.read().decode()}")
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", cls.port)) == 0:
                    return
            time.sleep(0.05)
        raise SystemExit("nginx does not answer")

    @classmethod
    def tearDownClass(cls):
        cls.server.send_signal(signal.SIGQUIT)
        cls.server.wait(timeout=20)
        cls.server.stderr.close()
        cls.temporary.cleanup()

    def ask(self, path, method="GET", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request(method, path, headers={name.replace("_", "-"): value
                                                  for name, value in headers.items()})
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, answer.headers, body

    def test_a_tile_has_its_type_and_is_for_every_origin(self):
        status, headers, body = self.ask("/st/tiles/0/0/0.glb", Accept_Encoding="gzip")
        self.assertEqual((status, body), (200, b"glTF tile"))
        self.assertEqual(headers["Content-Type"], "model/gltf-binary")
        self.assertEqual(headers["Access-Control-Allow-Origin"], "*")
        self.assertIn("max-age", headers["Cache-Control"])
        self.assertIsNone(headers["Content-Encoding"])

    def test_json_is_compressed_and_asked_for_each_time(self):
        status, headers, body = self.ask("/st/tileset.json", Accept_Encoding="gzip")
        self.assertEqual(status, 200)
        self.assertEqual(headers["Content-Encoding"], "gzip")
        self.assertEqual(gzip.decompress(body), self.json)
        self.assertEqual(headers["Content-Type"], "application/json")
        self.assertEqual(headers["Cache-Control"], "no-cache")
        self.assertEqual(headers["Vary"], "Accept-Encoding")
        self.assertEqual(self.ask("/st/tileset.json")[2], self.json)

    def test_what_lies_compressed_beside_a_file_is_sent(self):
        _, headers, body = self.ask("/st/layer.json", Accept_Encoding="gzip")
        self.assertEqual(headers["Content-Encoding"], "gzip")
        self.assertEqual(gzip.decompress(body), b"{'beside': 1}")

    def test_quantized_mesh_is_gzipped_once_and_says_so(self):
        _, headers, body = self.ask("/st/0/0/0.terrain", Accept_Encoding="gzip")
        self.assertEqual(headers.get_all("Content-Encoding"), ["gzip"])
        self.assertEqual(headers["Content-Type"], "application/vnd.quantized-mesh")
        self.assertEqual(gzip.decompress(body), b"quantized mesh")

    def test_an_archive_is_read_by_ranges(self):
        status, headers, body = self.ask("/st.pmtiles", Range="bytes=0-6", Accept_Encoding="gzip")
        self.assertEqual((status, body), (206, b"PMTiles"))
        self.assertEqual(headers["Content-Range"], "bytes 0-6/15")
        self.assertIn("Content-Range", headers["Access-Control-Expose-Headers"])
        self.assertEqual(self.ask("/st.pmtiles", Range="bytes=99-")[0], 416)
        etag = headers["ETag"]
        self.assertEqual(self.ask("/st.pmtiles", If_None_Match=etag)[0], 304)

    def test_a_browser_on_another_host_may_ask_for_ranges(self):
        status, headers, _ = self.ask("/st.pmtiles", method="OPTIONS", Origin="http://elsewhere",
                                      Access_Control_Request_Headers="range")
        self.assertEqual(status, 204)
        self.assertEqual(headers.get_all("Access-Control-Allow-Origin"), ["*"])
        self.assertIn("Range", headers["Access-Control-Allow-Headers"])

    def test_hidden_files_stay_hidden(self):
        self.assertEqual(self.ask("/st/.work/key")[0], 404)


if __name__ == "__main__":
    if NGINX is None:
        print("skipped: nginx is missing (scripts/setup --servers installs it)")
        sys.exit(SKIPPED)
    unittest.main()
