"""The C++ kernels; everything else about the build is in pyproject.toml."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import chain
from pathlib import Path

import nanobind
from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

KERNELS = Path("codec/kernels")
NANOBIND = Path(nanobind.__file__).parent

# setuptools wants sources below this folder or as given; nanobind's are compiled as they are.
sources = sorted(str(path) for path in KERNELS.rglob("*.cpp"))
nanobind_source = os.path.relpath(NANOBIND / "src" / "nb_combined.cpp")
link_args = [] if sys.platform == "darwin" else ["-Wl,-s"]


class ParallelBuild(build_ext):
    """Compiles the sources of an extension side by side; setuptools does so for extensions only."""

    def build_extensions(self):
        compile_in_turn = self.compiler.compile

        def compile_sources(sources, **options):
            with ThreadPoolExecutor(os.cpu_count()) as pool:
                objects = pool.map(lambda source: compile_in_turn([source], **options), sources)
                return list(chain.from_iterable(objects))

        self.compiler.compile = compile_sources
        super().build_extensions()


setup(
    cmdclass={"build_ext": ParallelBuild},
    ext_modules=[
        Extension(
            "ebz.codec._kernels",
            sources=[*sources, nanobind_source],
            depends=sorted(str(path) for path in KERNELS.rglob("*.hpp")),
            include_dirs=[
                nanobind.include_dir(),
                str(NANOBIND / "ext" / "robin_map" / "include"),
            ],
            language="c++",
            extra_compile_args=[
                "-std=c++20",
                "-O3",
                "-ffp-contract=off",
                "-fvisibility=hidden",
                "-fno-strict-aliasing",
                "-fno-tree-slp-vectorize",  # what loops carry along is faster unpacked
                "-DNDEBUG",
            ],
            extra_link_args=link_args,
        )
    ],
)
