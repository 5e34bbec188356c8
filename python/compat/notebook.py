"""Executes docs/notebooks/quickstart.ipynb as Jupyter would, and says how many of its cells printed or drew something."""

from pathlib import Path

import nbformat
from nbclient import NotebookClient

path = Path(__file__).resolve().parent.parent.parent / "docs/notebooks/quickstart.ipynb"
notebook = nbformat.read(path, as_version=4)
NotebookClient(notebook, timeout=900).execute()
shown = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.outputs]
assert len(shown) >= 5, len(shown)
print(f"{len(shown)} cells printed or drew something")
