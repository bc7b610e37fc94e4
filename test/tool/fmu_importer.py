# SPDX-License-Identifier: BSD-3-Clause
"""A small importer of FMI 3.0: does the calls that lines of standard input name, one a line, and answers each with a
line: its status, then values as hexadecimal floating-point numbers. The unit's messages go to standard error.

  fmu_importer.py LIBRARY TOKEN RESOURCES

  new I [EVENTS] | free I | enter I START STOP | exit I | terminate I | reset I | step I TIME LENGTH [TIMES]
  get I TYPE REFERENCE COUNT | set I TYPE REFERENCE COUNT VALUE ...    TYPE: Float64, Int32, Boolean, String
  keep I S | restore I S | drop I S | call I NAME                       I, S: numbers; STOP: nan where there is none
  save I S FILE | load I S FILE: the state as bytes; save says where a byte more or less is not refused
  allocations I: how often memory was asked for in steps so far | logging I ON CATEGORY

Invalid operations of floating-point numbers trap in steps and at the end of the initialisation. LD_PRELOAD is the
library that counts allocations.
"""
import ctypes
import math
import os
import pathlib
import sys
from ctypes import byref, c_bool, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p

KINDS = {"Float64": c_double, "Int32": c_int, "Boolean": c_bool, "String": c_char_p}
CALLS = {"exit": "ExitInitializationMode", "terminate": "Terminate", "reset": "Reset", "keep": "GetFMUState",
         "restore": "SetFMUState", "drop": "FreeFMUState"}
TRAPS = 5  # FE_INVALID, FE_DIVBYZERO
LOGGER = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p)
log = LOGGER(lambda _, status, category, message: print("drive", status, category.decode(), message.decode(),
                                                        file=sys.stderr, flush=True))
mathematics = ctypes.CDLL("libm.so.6")
allocations_so_far = ctypes.CDLL(os.environ["LD_PRELOAD"])["_ZN3hjt15allocationCountEv"]
allocations_so_far.restype = c_size_t


class Importer:
    def __init__(self, library, token, resources):
        self.unit = ctypes.CDLL(library)
        self.unit.fmi3InstantiateCoSimulation.restype = c_void_p
        self.unit.fmi3GetVersion.restype = c_char_p
        self.place = token.encode(), resources.encode()
        self.instances, self.states, self.allocations = {}, {}, 0

    def call(self, instance, name, *words):
        """The status; numbers trap."""
        function = self.unit["fmi3" + name]
        pointer = c_void_p(self.instances.get(instance))
        mathematics.feenableexcept(TRAPS)
        status = function(pointer, *words)
        assert mathematics.fedisableexcept(-1) == TRAPS
        return status

    def state(self, name):
        return self.states.setdefault(name, c_void_p())

    def values(self, instance, call, kind, reference, count, *words):
        made = {"String": str.encode, "Float64": float}.get(kind, lambda word: int(float(word)))
        values = (KINDS[kind] * int(count))(*map(made, words))
        status = self.call(instance, call + kind, byref(c_uint(int(reference))), c_size_t(1), values,
                           c_size_t(int(count)))
        return status, values

    def get(self, instance, kind, *words):
        status, values = self.values(instance, "Get", kind, *words)
        texts = [value.decode() if kind == "String" else float(value).hex() for value in values] if status == 0 else []
        return " ".join([str(status), *texts])

    def set(self, instance, kind, *words):
        return self.values(instance, "Set", kind, *words)[0]

    def new(self, instance, events=None):
        self.instances[instance] = self.unit.fmi3InstantiateCoSimulation(
            b"drive", *self.place, False, True, bool(events), False, None, c_size_t(0), b"drive", log, None)
        return int(not self.instances[instance])

    def free(self, instance):
        self.call(instance, "FreeInstance")
        del self.instances[instance]
        return 0

    def enter(self, instance, start, stop):
        return self.call(instance, "EnterInitializationMode", False, c_double(0.0), c_double(float(start)),
                         not math.isnan(float(stop)), c_double(float(stop)))

    def step(self, instance, begin, length, times=1):
        begin, length, status = float(begin), float(length), 0
        ends, last = [c_bool(True) for _ in range(3)], c_double(math.nan)
        pointer, results = c_void_p(self.instances.get(instance)), [*map(byref, ends), byref(last)]
        function = self.unit.fmi3DoStep
        function.argtypes = [c_void_p, c_double, c_double, c_bool] + 4 * [c_void_p]
        before = allocations_so_far()
        mathematics.feenableexcept(TRAPS)
        for i in range(int(times)):
            status = function(pointer, begin + i * length, length, True, *results)
            if status:
                break
        assert mathematics.fedisableexcept(-1) == TRAPS
        self.allocations += allocations_so_far() - before
        assert status or not any(end.value for end in ends) and abs(last.value - begin - int(times) * length) < 1e-9
        return status

    def logging(self, instance, on, category):
        return self.call(instance, "SetDebugLogging", on != "0", c_size_t(1), byref(c_char_p(category.encode())))

    def save(self, instance, name, *path):
        size, state = c_size_t(), self.state(name)
        status = self.call(instance, "SerializedFMUStateSize", state, byref(size))
        if status == 0:
            data = (ctypes.c_ubyte * (size.value + 1))()
            for other in -1, 1:
                assert self.call(instance, "SerializeFMUState", state, data, c_size_t(size.value + other)) != 0
            status = self.call(instance, "SerializeFMUState", state, data, size)
            pathlib.Path(" ".join(path)).write_bytes(bytes(data)[:-1])
        return status

    def load(self, instance, name, *path):
        data = pathlib.Path(" ".join(path)).read_bytes()
        return self.call(instance, "DeserializeFMUState", data, c_size_t(len(data)), byref(self.state(name)))

    def answer(self, command, instance, *words):
        if command == "allocations":
            return self.allocations
        if command == "call":
            return self.call(instance, words[0][len("fmi3"):])
        if command in CALLS:
            states = [self.state(name) if command == "restore" else byref(self.state(name)) for name in words]
            return self.call(instance, CALLS[command], *states)
        return getattr(self, command)(instance, *words)


if __name__ == "__main__":
    importer = Importer(*sys.argv[1:])
    print(importer.unit.fmi3GetVersion().decode(), flush=True)
    for line in sys.stdin:
        print(importer.answer(*line.split()), flush=True)
