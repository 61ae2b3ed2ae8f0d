"""Sinew from another language by its interface of C: here Python's ctypes, without the package.

Usage: by_ctypes.py [libsinew.so]
"""

import ctypes
import sys

SCENE = b"""
[body.block]
shape = "box"
cells = [4, 4, 4]
size = [0.1, 0.1, 0.1]
young = 20e3
[pin.top]
select = { side = "+y" }
"""


class Array(ctypes.Structure):
    _fields_ = [("data", ctypes.POINTER(ctypes.c_double)), ("count", ctypes.c_size_t),
                ("components", ctypes.c_size_t), ("stride", ctypes.c_size_t)]


def main(library):
    sinew = ctypes.CDLL(library)
    sinew.sinew_error.restype = sinew.sinew_version.restype = ctypes.c_char_p
    sinew.sinew_time.restype = ctypes.c_double
    sinew.sinew_positions.restype = Array
    sinew.sinew_advance.argtypes = [ctypes.c_void_p, ctypes.c_double, ctypes.c_void_p]
    simulation = ctypes.c_void_p()

    def call(function, *arguments):
        if function(*arguments) != 0:
            raise SystemExit(sinew.sinew_error().decode())

    call(sinew.sinew_open_text, SCENE, None, None, 0, 0, ctypes.byref(simulation))
    for _ in range(5):
        call(sinew.sinew_advance, simulation, 0.02, None)
        x = sinew.sinew_positions(simulation)
        lowest = min(x.data[3 * i + 1] for i in range(x.count))
        print(f"{sinew.sinew_time(simulation):.2f} s: the lowest of {x.count} nodes at "
              f"{1e3 * lowest:.2f} mm")
    if sinew.sinew_advance(simulation, -1.0, None) == 0:
        raise SystemExit("time does not run backwards")
    print(sinew.sinew_error().decode().splitlines()[0])
    sinew.sinew_close(simulation)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "libsinew.so.0")
