"""The benchmark, as `warpsph bench`; all options are the same.

python tools/benchmark.py --quick --json
"""

import typer

from warpsph.cli.bench import bench

if __name__ == "__main__":
    typer.run(bench)
