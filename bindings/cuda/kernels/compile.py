"""Compiles the kernels to PTX by NVRTC, which `cargo xtask cuda` installs: compile.py OUTPUT.

The PTX has no fused operation, and every operation that rounds says so (`.rn`), so ptxas may not fuse any either.
"""

import ctypes
import pathlib
import re
import sys

import nvidia.cuda_nvrtc

FOLDER = pathlib.Path(__file__).parent
LIBRARY = next(pathlib.Path(path) for path in nvidia.cuda_nvrtc.__path__) / "lib" / "libnvrtc.so.12"
OPTIONS = ["--gpu-architecture=compute_70", "--fmad=false", "--std=c++17", "--device-as-default-execution-space"]


def source(name: str, seen: set[str]) -> str:
    """Return a file with the files that it includes, each once."""
    if name in seen:
        return ""
    seen.add(name)
    text = (FOLDER / name).read_text().replace("#pragma once\n", "")
    return re.sub(r'#include "(.*)"\n', lambda match: source(match[1], seen), text)


def compiled() -> str:
    """Return the PTX of the kernels."""
    nvrtc = ctypes.CDLL(str(LIBRARY))
    program = ctypes.c_void_p()
    text = source("kernels.cu", set()).encode()
    assert nvrtc.nvrtcCreateProgram(ctypes.byref(program), text, b"kernels.cu", 0, None, None) == 0
    options = (ctypes.c_char_p * len(OPTIONS))(*(option.encode() for option in OPTIONS))
    status = nvrtc.nvrtcCompileProgram(program, len(OPTIONS), options)
    get = "PTX" if status == 0 else "ProgramLog"
    size = ctypes.c_size_t()
    getattr(nvrtc, f"nvrtcGet{get}Size")(program, ctypes.byref(size))
    buffer = ctypes.create_string_buffer(size.value)
    getattr(nvrtc, f"nvrtcGet{get}")(program, buffer)
    if status != 0:
        sys.exit(buffer.value.decode())
    return buffer.value.decode()


ptx = compiled()
# A fused operation, one that is not rounded to nearest, and one without numbers below the normal range change bits.
rounded = r"^\s*(?:@!?%p\d+\s+)?(?:add|sub|mul|div|sqrt|rcp)\.(?!rn\.f)[a-z.]*f(?:32|64)\b.*"
wrong = re.findall(rounded + r"|^.*\b(?:fma|mad)\.[a-z.]*f(?:32|64)\b.*|^.*\.(?:ftz|approx)\b.*", ptx, re.M)
if wrong:
    sys.exit(f"operations that do not round as the contract says: {wrong[:5]}")
pathlib.Path(sys.argv[1]).write_text(ptx)
