"""Machine code of traced programs, by LLVM for the very processor it runs on."""

from __future__ import annotations

import ctypes
import hashlib
from typing import Any

from flexbase.errors import import_extra
from flexbase.trace.targets.llvm import ENTRY, print_llvm
from flexbase.trace.tracer import Program

Entry = Any  # a C function: (x, y, x_stride, y_stride, cells, steps)


def processor() -> str:
    """Names the compiler and the processor: machine code is good for no other pair."""
    llvm = import_extra("llvmlite.binding", "fast")
    features = hashlib.sha256(llvm.get_host_cpu_features().flatten().encode()).hexdigest()[:12]
    version = ".".join(map(str, llvm.llvm_version_info))
    return f"llvm {version} {llvm.get_process_triple()} {llvm.get_host_cpu_name()} {features}"


def compile_program(program: Program, iterate: bool = False) -> bytes:
    """An object file; `iterate` as in `print_llvm`. Raises MissingExtra without llvmlite."""
    llvm = import_extra("llvmlite.binding", "fast")
    module = llvm.parse_assembly(print_llvm(program, iterate))
    module.verify()
    return bytes(_target().emit_object(module))


class MachineCode:
    """An object file, linked into this process; it lives as long as this does."""

    def __init__(self, code: bytes) -> None:
        llvm = import_extra("llvmlite.binding", "fast")
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _target())
        self._engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        self._engine.finalize_object()
        signature = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 2, *[ctypes.c_int64] * 4)
        self.entry: Entry = signature(self._engine.get_function_address(ENTRY))


def _target() -> Any:
    """A description of this processor; an engine takes the one that it is given for its own."""
    llvm = import_extra("llvmlite.binding", "fast")
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten(), opt=2
    )
