#!/usr/bin/env python3
"""Executes a notebook in a kernel of its own, and fails if a cell does, or if no cell shows a picture.

usage: run_notebook.py FILE

The kernel works in a folder that is removed. The file is not changed: notebooks are kept without outputs.
"""
import os
import pathlib
import sys
import tempfile

import nbclient
import nbformat


def main():
    os.environ.pop("MPLBACKEND", None)  # the kernel's own, which puts pictures into the outputs
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # nobody debugs it
    file = pathlib.Path(sys.argv[1])
    notebook = nbformat.read(file, as_version=4)
    nbformat.validate(notebook)
    for cell in notebook.cells:
        if cell.cell_type == "code" and (cell.outputs or cell.execution_count is not None):
            sys.exit(f"{file.name}: has outputs: keep notebooks without")
    with tempfile.TemporaryDirectory(prefix="swiftlet-notebook-") as folder:
        client = nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3",
                                         resources={"metadata": {"path": folder}})
        try:
            client.execute()
        except nbclient.exceptions.CellExecutionError as error:
            sys.exit(f"{file.name}: {error}")
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    pictures = sum("image/png" in output.get("data", {}) for cell in cells for output in cell.outputs)
    if pictures == 0:
        sys.exit(f"{file.name}: shows no picture")
    print(f"{len(cells)} cells, {pictures} pictures")


main()
