"""deploy/setup/audit.sh: its own tools at exact versions, and no pass for an audit of nothing."""

import re
import subprocess


def test_it_says_what_it_can_do(repository):
    command = ["bash", str(repository / "deploy/setup/audit.sh"), "everything"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=30, check=False)
    assert run.returncode == 2
    assert "needs 'sbom' or 'audit', got 'everything'" in run.stderr


def test_its_tools_have_exact_versions_and_are_none_of_the_projects(repository):
    lines = (repository / "deploy/setup/audit-requirements.txt").read_text(encoding="utf-8").splitlines()
    tools = [line for line in lines if not line.startswith("#")]
    assert all(re.fullmatch(r"[a-z-]+==[\d.]+", tool) for tool in tools)
    pinned = (repository / "constraints.txt").read_text(encoding="utf-8").lower()
    assert not any(tool.partition("==")[0] + "==" in pinned for tool in tools)


def test_what_could_not_be_looked_up_fails_the_audit(repository):
    assert "--strict" in (repository / "deploy/setup/audit.sh").read_text(encoding="utf-8")
