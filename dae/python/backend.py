"""Builds the wheel of the package: what `pip install ./dae/python` calls (PEP 517).

CMake builds the compiled part in build/python of this project. A build folder that has it already
is taken as it is, a path seen from the project's top:

    pip install --config-settings build=build/release ./dae/python
    MOMENTA_BUILD=build/release pip install ./dae/python
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

_here = pathlib.Path(__file__).resolve().parent
_top = _here.parents[1]
_module = "_momenta" + sysconfig.get_config_var("EXT_SUFFIX")
_platform = re.sub("[-.]", "_", sysconfig.get_platform())
_tag = "cp{0}{1}-cp{0}{1}-{2}".format(*sys.version_info[:2], _platform)
_version = re.search(r"project\(momenta VERSION ([0-9.]+)", (_top / "CMakeLists.txt").read_text()).group(1)
_info = f"momenta-{_version}.dist-info"
_metadata = {
    "METADATA": f"""Metadata-Version: 2.1
Name: momenta
Version: {_version}
Summary: Constrained multibody systems on canonical momenta
License: BSD-3-Clause
Requires-Python: >=3.9
Requires-Dist: numpy
Provides-Extra: plot
Requires-Dist: matplotlib; extra == "plot"
""",
    "WHEEL": f"Wheel-Version: 1.0\nGenerator: momenta\nRoot-Is-Purelib: false\nTag: {_tag}\n",
}


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    compiled = _compiled((config_settings or {}).get("build") or os.environ.get("MOMENTA_BUILD"))
    sources = [path for path in sorted((_here / "momenta").iterdir()) if path.is_file()]
    files = {f"momenta/{path.name}": path.read_bytes() for path in [*sources, compiled]}
    files |= {f"{_info}/{name}": text.encode() for name, text in _metadata.items()}
    files[f"{_info}/LICENSE"] = (_top / "LICENSE").read_bytes()
    record = "".join(f"{name},sha256={_digest(x)},{len(x)}\n" for name, x in files.items())
    files[f"{_info}/RECORD"] = f"{record}{_info}/RECORD,,\n".encode()
    wheel = f"momenta-{_version}-{_tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = pathlib.Path(metadata_directory) / _info
    folder.mkdir()
    for name, text in _metadata.items():
        (folder / name).write_text(text)
    return _info


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit(
        "momenta: the folder dae/python alone does not hold the library; expected "
        "`pip wheel ./dae/python` in the project's folder"
    )


def _compiled(build):
    """The compiled part, of a build folder that is given or of one made here."""
    folder = _top / (build or "build/python")
    if not build:
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "MOMENTA_PYTHON": "ON",
            "MOMENTA_TESTS": "OFF",
            "MOMENTA_BENCHMARKS": "OFF",
            "Python3_EXECUTABLE": sys.executable,
        }
        given = [f"-D{name}={value}" for name, value in options.items()]
        make = ["--target", "momenta_python", "--parallel", str(os.cpu_count())]
        subprocess.run(["cmake", "-S", _top, "-B", folder, *given], check=True)
        subprocess.run(["cmake", "--build", folder, *make], check=True)
    compiled = folder / "dae" / "python" / "momenta" / _module
    if not compiled.is_file():
        raise SystemExit(
            f"momenta: {compiled} is not there; expected a build folder with the target "
            f"momenta_python built for {sys.executable}"
        )
    return compiled


def _digest(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
