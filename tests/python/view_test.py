"""sinew.view and Simulation.show: the view takes a simulation over and gives it back."""

import base64
import json
import os
import socket
import time
import unittest
import urllib.parse
import urllib.request

import numpy as np
import sinew
from python_support import BEAM, PythonTest


class Page:
    """What the page does, without a browser: one WebSocket (RFC 6455) that sends commands."""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.socket = socket.create_connection((parts.hostname, parts.port), timeout=20)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /live?{parts.query} HTTP/1.1\r\nHost: {parts.netloc}\r\n"
                             "Upgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
                             ).encode())
        answer = self.socket.recv(4096)
        assert b" 101 " in answer, answer

    def send(self, **message):
        payload = json.dumps(message).encode()
        mask = os.urandom(4)
        head = bytes([0x81, 0x80 | len(payload)]) if len(payload) < 126 else (
            bytes([0x81, 0x80 | 126]) + len(payload).to_bytes(2, "big"))
        self.socket.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload)))

    def close(self):
        self.socket.close()


class ViewTest(PythonTest):
    def test_the_page_steps_it_and_gives_it_back(self):
        sim = sinew.Simulation(BEAM)
        sim.advance(0.05)
        time_before = sim.time
        with sinew.view(sim, browser=False) as view:
            self.assertTrue(view.is_open)
            with self.assertRaises(sinew.UsageError) as caught:
                sim.advance(0.01)
            self.assertIn("close()", str(caught.exception))
            for change in (lambda: sinew.view(sim, browser=False),
                           lambda: sim.material("beam").change(young=100e3),
                           lambda: sim.pin("wall").move([0, 0.01, 0]), lambda: sim.restore(sim.save()),
                           lambda: sim.add_obstacle("ball", shape="sphere", radius=0.01)):
                with self.assertRaises(sinew.UsageError):
                    change()
            page = Page(view.url)
            page.send(type="play", running=True)
            time.sleep(1.0)
            page.send(type="play", running=False)
            time.sleep(0.3)
            page.close()
        self.assertFalse(view.is_open)
        self.assertEqual(view.url, "")
        self.assertGreater(sim.time, time_before + 0.05)
        self.assertTrue(np.isfinite(sim.positions).all())
        after = sim.time
        sim.advance(0.05)
        self.assertAlmostEqual(sim.time, after + 0.05)

    def test_untouched_it_keeps_its_bits(self):
        for stepper in ("auto", "verlet", "implicit"):
            shown, alone = (sinew.Simulation(BEAM, set={"stepper": stepper}) for _ in range(2))
            for sim in (shown, alone):
                sim.advance(0.05)
            sinew.view(shown, browser=False).close()
            self.assertEqual(shown.hash(), alone.hash())
            for sim in (shown, alone):
                sim.advance(0.05)
            self.assertEqual(shown.hash(), alone.hash())

    def test_another_material_stays_in_the_view(self):
        sim = sinew.Simulation(BEAM)
        sim.advance(0.05)
        x = sim.positions.copy()
        view = sinew.view(sim, browser=False)
        page = Page(view.url)
        page.send(type="material", key="young", value=20e3)
        time.sleep(0.5)
        page.close()
        with self.assertRaises(sinew.UsageError) as caught:
            view.close()
        self.assertIn("another scene or material", str(caught.exception))
        np.testing.assert_array_equal(sim.positions, x)
        sim.advance(0.01)

    def test_in_a_notebook(self):
        sim = sinew.Simulation(BEAM)
        view = sim.show(height=300)
        self.assertIn(f'<iframe src="{view.url}"', view._repr_html_())
        self.assertIn("?token=", view.url)  # a frame that another page does not open
        with urllib.request.urlopen(view.url) as answer:
            policy = answer.headers["Content-Security-Policy"]
            self.assertIsNone(answer.headers["X-Frame-Options"])
        self.assertIn("frame-ancestors http://localhost:*", policy)
        view.close()
        self.assertIn("closed", view._repr_html_())

    def test_a_rest_state_moves_in_the_view(self):
        sim = sinew.static(sinew.Scene.from_file(str(self.write("beam.toml", BEAM))))
        x = sim.positions.copy()
        with sinew.view(sim, browser=False):
            pass
        np.testing.assert_array_equal(sim.positions, x)


if __name__ == "__main__":
    unittest.main()
