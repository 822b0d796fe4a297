"""`warpsph schema`: the JSON schema of scene files."""

from __future__ import annotations

from warpsph.cli.failures import ExitCode, reported
from warpsph.cli.options import Verbose


@reported
def schema(verbose: Verbose = False) -> ExitCode:
    """Print the JSON schema of scene files, by which editors complete and check them."""
    import json

    from warpsph.scene import scene_json_schema

    print(json.dumps(scene_json_schema(), indent=2))
    return ExitCode.OK
