"""portal.py: Calx from Python through ctypes: python3 portal.py LIBCALX CASE.json. Needs nothing but Python; where numpy
is installed the particle columns are numpy arrays over the engine's own memory."""
import ctypes
import sys

try:
    import numpy
except ImportError:
    numpy = None


class Options(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("threads", ctypes.c_int32), ("device", ctypes.c_char_p),
                ("precision", ctypes.c_char_p), ("plugin_path", ctypes.c_char_p), ("folder", ctypes.c_char_p),
                ("plugins", ctypes.c_void_p), ("set", ctypes.POINTER(ctypes.c_char_p))]


class Column(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("rows", ctypes.c_uint64), ("stride", ctypes.c_uint32),
                ("components", ctypes.c_uint32), ("unit", ctypes.c_char_p), ("is_integer", ctypes.c_int32),
                ("writable", ctypes.c_int32)]


class Simulation:
    def __init__(self, library, path, **overrides):
        self.c = ctypes.CDLL(library)
        self.c.calx_sim_error.restype = ctypes.c_char_p
        self.c.calx_sim_time.restype = ctypes.c_double
        texts = [f"{pointer}={value}".encode() for pointer, value in overrides.get("set", {}).items()]
        words = (ctypes.c_char_p * (len(texts) + 1))(*texts, None)
        options = Options(struct_size=ctypes.sizeof(Options), threads=1, set=words)
        self.sim = ctypes.c_void_p()
        self.check(self.c.calx_sim_open(path.encode(), ctypes.byref(options), ctypes.byref(self.sim)))

    def __del__(self):
        if getattr(self, "sim", None):
            self.c.calx_sim_destroy(self.sim)

    def check(self, code):
        if code != 0:
            raise RuntimeError(f"{self.c.calx_sim_error().decode()} (code {code})")

    def run_until(self, time):
        self.check(self.c.calx_sim_run_until(self.sim, ctypes.c_double(time)))

    @property
    def time(self):
        return self.c.calx_sim_time(self.sim)

    def column(self, name):
        """Rows of a particle column; with numpy a view of the engine's memory, valid until the next step."""
        c = Column()
        self.check(self.c.calx_sim_particles(self.sim, name.encode(), ctypes.byref(c)))
        kind = ctypes.c_uint32 if c.is_integer else ctypes.c_double
        if numpy is None:
            return [list((kind * c.components).from_address(c.data + k * c.stride)) for k in range(c.rows)]
        memory = (ctypes.c_char * (c.stride * c.rows)).from_address(c.data)
        size = ctypes.sizeof(kind)
        return numpy.ndarray((c.rows, c.components), dtype=numpy.uint32 if c.is_integer else float, buffer=memory,
                             strides=(c.stride, size))

    def digest(self):
        text = ctypes.create_string_buffer(65)
        self.check(self.c.calx_sim_digest(self.sim, text))
        return text.value.decode()


def main():
    sim = Simulation(sys.argv[1], sys.argv[2])
    sim.run_until(0.1)
    print(f"t = {sim.time:.4f} s, heights in mm:", ", ".join(f"{1e3 * row[2]:.3f}" for row in sim.column("position")))
    print(sim.digest())


if __name__ == "__main__":
    main()
