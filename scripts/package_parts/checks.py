"""Checks a native library of any platform with LLVM's tools, on any machine: its exports, the oldest system that it
supports, its dependencies, its signature. A check returns its finding, for the table, or raises CheckFailed.
"""

import hashlib
import re
import struct
import subprocess

from platforms import ROOT

# Libraries that each system provides. On Windows, api-ms-win-crt-* are parts of the Universal C Runtime.
LINUX_LIBRARIES = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2",
                   "ld-linux-aarch64.so.1"}
WINDOWS_LIBRARIES = re.compile(r"(kernel32|ntdll|advapi32|ucrtbase|api-ms-win-crt-[a-z0-9-]+)\.dll", re.I)
MACOS_LIBRARIES = {"/usr/lib/libSystem.B.dylib"}
HEADERS = [ROOT / "native/include" / name for name in ("partwheel.h", "partwheel_edit.h")]
MAX_GLIBC, MAX_MACOS = "2.28", "11.0"  # a library must not need later versions


class CheckFailed(Exception):
    """The library must not be shipped. str() says why."""


def check(library, platform):
    """{column of the table: finding} for a library of the platform. Raises CheckFailed."""
    system = platform.split("-")[0]
    symbols, dependencies, minimum = {"linux": _elf, "windows": _pe, "macos": _mach}[system](library)
    declared = set(re.findall(r"^PW_API [^;(]*?(pw_\w+)\(", "".join(path.read_text() for path in HEADERS), re.M))
    if symbols != declared:
        raise CheckFailed(f"{library} exports {sorted(symbols - declared)}, which the headers don't declare, and not "
                          f"{sorted(declared - symbols)}, which they do.")
    findings = {"exports": f"{len(symbols)} pw_*", "minimum": minimum, "needs": ", ".join(sorted(dependencies))}
    if system == "macos":
        findings["signed"] = _verify_signature(library.read_bytes()) or "no, not required on Intel"
        if findings["signed"] != "ad hoc" and platform == "macos-arm64":
            raise CheckFailed(f"{library} has no signature, which Apple silicon requires.")
    return findings


def _elf(library):
    symbols = {line.split()[-1] for line in _output("llvm-nm", "-D", "--defined-only", library).splitlines() if line}
    dependencies = set(re.findall(r"NEEDED\)? +(?:Shared library: \[)?([^\s\]]+)", _output("llvm-readelf", "-d", library)))
    _require_only(library, dependencies, dependencies - LINUX_LIBRARIES)
    versions = re.findall(r"@GLIBC_([0-9.]+)", _output("llvm-nm", "-D", "--undefined-only", library))
    minimum = max(versions, key=_version)
    if _version(minimum) > _version(MAX_GLIBC):
        raise CheckFailed(f"{library} needs glibc {minimum}, later than {MAX_GLIBC}.")
    return symbols, dependencies, f"glibc {minimum}"


def _pe(library):
    text = _output("llvm-readobj", "--coff-exports", "--coff-imports", library)
    symbols = set(re.findall(r"Export \{[^}]*?Name: (\S+)", text))
    dependencies = set(re.findall(r"Import \{\s*Name: (\S+)", text))
    _require_only(library, dependencies, {name for name in dependencies if not WINDOWS_LIBRARIES.fullmatch(name)})
    dependencies = {re.sub(r"api-ms-win-crt-.*", "Universal C Runtime", name, flags=re.I) for name in dependencies}
    return symbols, dependencies, "Windows 10"


def _mach(library):
    symbols = {line.split()[-1].removeprefix("_")
               for line in _output("llvm-nm", "--extern-only", "--defined-only", library).splitlines() if " " in line}
    lines = _output("llvm-objdump", "--macho", "--dylibs-used", library).splitlines()[1:]
    library_id = _output("llvm-objdump", "--macho", "--dylib-id", library).split()[-1]
    dependencies = {line.split()[0] for line in lines if line.strip()} - {library_id}
    _require_only(library, dependencies, dependencies - MACOS_LIBRARIES)
    minimum = re.search(r"LC_BUILD_VERSION.*?minos ([0-9.]+)", _output("llvm-objdump", "--macho", "--private-headers", library),
                      re.S)[1]
    if _version(minimum) > _version(MAX_MACOS):
        raise CheckFailed(f"{library} needs macOS {minimum}, later than {MAX_MACOS}.")
    return symbols, dependencies, f"macOS {minimum}"


def _version(text):
    return tuple(map(int, text.split(".")))


def _require_only(library, dependencies, foreign):
    if foreign or not dependencies:
        raise CheckFailed(f"{library} needs {sorted(foreign)}, which systems don't provide." if foreign else
                          f"{library} needs no library at all: the tool's output was not understood.")


def _output(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout


def _verify_signature(data):
    """Returns "ad hoc" if a Mach-O file has an ad hoc signature with the right hash of each page, "" if it has none.

    Apple's cs_blobs.h defines the layout. Numbers in the signature are big-endian."""
    commands, = struct.unpack_from("<I", data, 16)
    offset, signature = 32, None
    for _ in range(commands):
        command, size = struct.unpack_from("<II", data, offset)
        if command == 0x1D:  # LC_CODE_SIGNATURE
            signature = struct.unpack_from("<I", data, offset + 8)[0]
        offset += size
    if signature is None:
        return ""
    _, _, count = struct.unpack_from(">III", data, signature)
    blobs = [struct.unpack_from(">II", data, signature + 12 + 8 * i) for i in range(count)]
    directory = next(signature + position for kind, position in blobs if kind == 0)  # of code
    magic, _, version, flags, hashes, _, _, slots, limit = struct.unpack_from(">9I", data, directory)
    hash_size, hash_type, _, page_bits = struct.unpack_from("4B", data, directory + 36)
    if (magic, hash_type, hash_size) != (0xFADE0C02, 2, 32) or not flags & 2 or limit != signature:
        raise CheckFailed("The signature is not an ad hoc SHA-256 signature of everything before it.")
    page = 1 << page_bits
    if slots != -(-limit // page):
        raise CheckFailed("The signature has too few pages.")
    for slot in range(slots):
        position = directory + hashes + 32 * slot
        if hashlib.sha256(data[slot * page:min((slot + 1) * page, limit)]).digest() != data[position:position + 32]:
            raise CheckFailed(f"The signature's hash of page {slot} is wrong.")
    return "ad hoc"
