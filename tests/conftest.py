import shutil
import sys
from pathlib import Path

import pytest

from fabric_cad.measured.shipped import shipped_families

sys.path.insert(0, str(Path(__file__).parent))


def pytest_addoption(parser):
    parser.addoption("--rewrite-golden", action="store_true", help="write the golden decks anew")


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with the shipped tables, as the current one."""
    shutil.copytree(shipped_families(), tmp_path / "families")
    monkeypatch.chdir(tmp_path)
    return tmp_path
