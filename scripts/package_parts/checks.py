"""Checks a native library of any platform with LLVM's tools, on any machine: its exports, the oldest system that it
supports, its dependencies, its signature. A check returns its finding, for the table, or raises Refused.
"""

import hashlib
import re
import struct
import subprocess

from platforms import ROOT

# Libraries that each system provides. On Windows, api-ms-win-crt-* are parts of the Universal C Runtime.
LINUX = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2",
         "ld-linux-aarch64.so.1"}
WINDOWS = re.compile(r"(kernel32|ntdll|advapi32|ucrtbase|api-ms-win-crt-[a-z0-9-]+)\.dll", re.I)
MACOS = {"/usr/lib/libSystem.B.dylib"}
GLIBC, MACOS_LEAST = (2, 28), (11, 0)


class Refused(Exception):
    """The library must not be shipped. str() says why."""


def check(library, platform):
    """{column of the table: finding} for a library of the platform. Raises Refused."""
    system = platform.split("-")[0]
    symbols, needed, least = {"linux": _elf, "windows": _pe, "macos": _mach}[system](library)
    declared = _declared_functions()
    if symbols != declared:
        raise Refused(f"{library} exports {sorted(symbols - declared)} too many, {sorted(declared - symbols)} too few.")
    found = {"exports": f"{len(symbols)} pw_*", "least": least, "needs": ", ".join(sorted(needed))}
    if system == "macos":
        found["signed"] = _verify_signature(library.read_bytes()) or "no, not required on Intel"
        if found["signed"] != "ad hoc" and platform == "macos-arm64":
            raise Refused(f"{library} has no signature, which Apple silicon requires.")
    return found


def _declared_functions():
    """The functions of the headers."""
    text = "".join((ROOT / "native/include" / name).read_text() for name in ("partwheel.h", "partwheel_edit.h"))
    return set(re.findall(r"PW_API [^;(]*?(pw_[a-z_0-9]+)\(", text))


def _elf(library):
    symbols = {line.split()[-1] for line in _output("llvm-nm", "-D", "--defined-only", library).splitlines() if line}
    needed = set(re.findall(r"NEEDED\)? +(?:Shared library: \[)?([^\s\]]+)", _output("llvm-readelf", "-d", library)))
    _require_only(library, needed, needed - LINUX)
    versions = re.findall(r"@GLIBC_([0-9.]+)", _output("llvm-nm", "-D", "--undefined-only", library))
    least = max(tuple(map(int, version.split("."))) for version in versions)
    if least > GLIBC:
        raise Refused(f"{library} needs glibc {least}, more than {GLIBC}.")
    return symbols, needed, "glibc " + ".".join(map(str, least))


def _pe(library):
    text = _output("llvm-readobj", "--coff-exports", "--coff-imports", library)
    symbols = set(re.findall(r"Export \{[^}]*?Name: (\S+)", text))
    needed = set(re.findall(r"Import \{\s*Name: (\S+)", text))
    _require_only(library, needed, {name for name in needed if not WINDOWS.fullmatch(name)})
    needed = {re.sub(r"api-ms-win-crt-.*", "Universal C Runtime", name, flags=re.I) for name in needed}
    return symbols, needed, "Windows 10"


def _mach(library):
    symbols = {line.split()[-1].removeprefix("_")
               for line in _output("llvm-nm", "--extern-only", "--defined-only", library).splitlines() if " " in line}
    lines = _output("llvm-objdump", "--macho", "--dylibs-used", library).splitlines()[1:]
    own = _output("llvm-objdump", "--macho", "--dylib-id", library).split()[-1]
    needed = {line.split()[0] for line in lines if line.strip()} - {own}
    _require_only(library, needed, needed - MACOS)
    least = re.search(r"LC_BUILD_VERSION.*?minos ([0-9.]+)", _output("llvm-objdump", "--macho", "--private-headers", library),
                      re.S)[1]
    if tuple(map(int, least.split("."))) > MACOS_LEAST:
        raise Refused(f"{library} needs macOS {least}, more than {MACOS_LEAST}.")
    return symbols, needed, f"macOS {least}"


def _require_only(library, needed, foreign):
    if foreign or not needed:
        raise Refused(f"{library} needs {sorted(foreign) or 'nothing'}, which systems don't provide.")


def _output(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def _verify_signature(data):
    """"ad hoc" if a Mach-O file has such a signature and each page's hash in it is right; "" without one.

    The layout: Apple's cs_blobs.h. Numbers in the signature are big-endian."""
    commands, = struct.unpack_from("<I", data, 16)
    offset, found = 32, None
    for _ in range(commands):
        command, size = struct.unpack_from("<II", data, offset)
        if command == 0x1D:  # LC_CODE_SIGNATURE
            found = struct.unpack_from("<I", data, offset + 8)[0]
        offset += size
    if found is None:
        return ""
    _, _, count = struct.unpack_from(">III", data, found)
    blobs = [struct.unpack_from(">II", data, found + 12 + 8 * i) for i in range(count)]
    directory = next(found + at for kind, at in blobs if kind == 0)  # of code
    magic, _, version, flags, hashes, _, _, slots, limit = struct.unpack_from(">9I", data, directory)
    hash_size, hash_type, _, page_bits = struct.unpack_from("4B", data, directory + 36)
    if (magic, hash_type, hash_size) != (0xFADE0C02, 2, 32) or not flags & 2 or limit != found:
        raise Refused("The signature is not an ad hoc SHA-256 signature of everything before it.")
    page = 1 << page_bits
    if slots != -(-limit // page):
        raise Refused("The signature has too few pages.")
    for slot in range(slots):
        at = directory + hashes + 32 * slot
        if hashlib.sha256(data[slot * page:min((slot + 1) * page, limit)]).digest() != data[at:at + 32]:
            raise Refused(f"The signature's hash of page {slot} is wrong.")
    return "ad hoc"
