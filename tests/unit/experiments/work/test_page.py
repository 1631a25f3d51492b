"""A study's page: tables, figures that are there, nothing that is not."""

from experiments.work.page import write_page


def test_a_page_holds_its_tables_and_the_figures_that_exist(tmp_path):
    (tmp_path / "there.png").write_bytes(b"picture")
    rows = [{"method": "1", "mean": 0.12345, "holds": True, "left": None}]
    tables = [("Errors", rows), ("Empty", [])]
    figures = [("Seen", "there.png"), ("Missing", "gone.png")]
    page = write_page(tmp_path, "study", "A study", "topnav study", tables, figures)
    text = page.read_text()
    assert "# A study" in text
    assert "| method | mean | holds | left |" in text
    assert "| 1 | 0.123 | yes |  |" in text
    assert "![Seen](there.png)" in text
    assert "gone.png" not in text
    assert "Empty" not in text
