"""Scripts of the repository that publishing needs."""

import csv
import importlib.util
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
URL = "https://example.org/somebody/hasard"


def tool(name):
    if str(ROOT / "tools") not in sys.path:
        sys.path.append(str(ROOT / "tools"))  # where a script finds the others
    spec = importlib.util.spec_from_file_location(name, ROOT / f"tools/{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def clone(tmp_path):
    for name in ("README.md", "Cargo.toml", "pyproject.toml", "CITATION.cff"):
        shutil.copy(ROOT / name, tmp_path / name)
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools/address.txt").write_text("")
    shutil.copytree(ROOT / "docs", tmp_path / "docs", ignore=shutil.ignore_patterns("pictures", "witness"))
    for manifest in ROOT.glob("crates/*/Cargo.toml"):
        to = tmp_path / manifest.relative_to(ROOT)
        to.parent.mkdir(parents=True)
        shutil.copy(manifest, to)
    return tmp_path


def test_without_an_address_pages_stay_as_they_are(clone):
    before = {path: path.read_bytes() for path in clone.rglob("*.md")}
    for what in ("--package-page", "--book"):
        tool("address").main([what], clone)
    assert before == {path: path.read_bytes() for path in clone.rglob("*.md")}


def test_an_address_is_written_everywhere_it_belongs_and_may_change(clone):
    address = tool("address")
    for url in (URL, URL + "2"):
        address.main([url], clone)
        assert f'repository = "{url}"\n' in (clone / "Cargo.toml").read_text()
        assert f'repository-code: "{url}"\n' in (clone / "CITATION.cff").read_text()
        assert (clone / "README.md").read_text().count("badge.svg") == 1
        assert f'Repository = "{url}"\n' in (clone / "pyproject.toml").read_text()
        # Nothing else is lost.
        assert (clone / "Cargo.toml").read_text().count("\n") == (ROOT / "Cargo.toml").read_text().count("\n")
        assert (clone / "CITATION.cff").read_text().count("\n") == (ROOT / "CITATION.cff").read_text().count("\n")
        for manifest in clone.glob("crates/*/Cargo.toml"):
            assert manifest.read_text().count("repository.workspace = true\n") == 1, manifest
    if sys.version_info >= (3, 11):
        import tomllib

        read = tomllib.loads((clone / "pyproject.toml").read_text())
        assert read["project"]["urls"]["Issues"] == URL + "2/issues" and read["project"]["scripts"]
        assert tomllib.loads((clone / "Cargo.toml").read_text())["workspace"]["package"]["repository"] == URL + "2"


def test_the_package_page_and_the_book_have_no_link_that_breaks(clone):
    address = tool("address")
    address.main([URL], clone)
    address.main(["--package-page"], clone)
    targets = [match[2] for match in address.LINK.finditer((clone / "README.md").read_text())]
    assert len(targets) > 30 and all(target.startswith("https://") for target in targets), targets
    assert f"{URL}/raw/main/docs/pictures/zoo/remedy_rush.gif" in targets
    assert f"{URL}/blob/main/docs/python.md" in targets
    address.main(["--book"], clone)
    page = (clone / "docs/scenarios.md").read_text()
    assert f"({URL}/blob/main/crates/envs/src/scenarios/remedy_rush/README.md)" in page and "(pictures/zoo/remedy_rush.gif)" in page


def test_a_word_that_is_no_address_is_refused(clone):
    for wrong in ("nonsense", "https://", "https://example.org/", "https://example.org/a/"):
        with pytest.raises(SystemExit, match="give an address"):
            tool("address").main([wrong], clone)


def test_readability_counts_sentences_of_prose_alone():
    page = "# Heading of one page\n\nOne two three four. Five six\nseven eight [nine](x.md) ten.\n\n- a list item of six\n\n```sh\n" + "x " * 90
    page += "\n```\n| a table | of many words that are no sentence |\n"
    words, wide = tool("readability").measure(page)
    assert (words, wide) == ([4, 4, 6, 5], 0)
    assert tool("readability").measure("word " * 40)[1] == 1


def test_readability_joins_the_wrapped_lines_of_a_help():
    text = "Do one thing\n\nUsage: hasard x [OPTIONS]\n\nOptions:\n      --size <WxH>\n          Frame size in so many\n          pixels. And more words here\n"
    text += "\n          [default: 4]\n\n  -o, --out <FILE>  File that is written, and the\n                    folder of it\n\nExamples:\n  hasard x a b c d e\n"
    readability = tool("readability")
    assert readability.descriptions(text).split("\n\n")[2:] == ["Frame size in so many pixels. And more words here", "File that is written, and the folder of it"]
    assert readability.measure(readability.descriptions(text))[0] == [6, 4, 9]


@pytest.mark.skipif(sys.version_info < (3, 11), reason="tomllib")
@pytest.mark.parametrize("recipe", sorted((ROOT / "python/examples").glob("*.py")), ids=lambda path: path.stem)
def test_a_recipe_names_the_extra_that_has_all_that_it_imports(recipe):
    import ast
    import re
    import tomllib

    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    tree = ast.parse(recipe.read_text())
    names = {alias.name.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    names |= {node.module.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module}
    others = {name.replace("_", "-") for name in names - sys.stdlib_module_names - {"hasard_rs", "numpy", "gymnasium"}}
    named = re.search(r"pip install '\.\[([a-z0-9-]+)\]'", ast.get_docstring(tree))
    if others:
        assert named, f"imports {others}, and its docstring names no extra"
        assert others <= {re.split(r"[\[>=<]", one)[0] for one in extras[named[1]]}


def test_small_copies_of_runs_draw_the_same_tables(tmp_path, hasard):
    """A real run of milliseconds, its copy, and the report of both."""

    def run(*words):
        return subprocess.run([hasard, *words], cwd=tmp_path, check=True, capture_output=True, text=True).stdout

    small = "--envs 4 --threads 1 --set network.dense=[32] --set network.recurrent=32 --set sampling.rollout=8 --size 64x48 --quiet"
    small += " --set evaluation.episodes=2 --set evaluation.confirming_episodes=2 --set reporting.report_seconds=0"
    train = "train RemedyRushLevel1 --frames 20000 --eval-every 10000 --out runs/one/seed3 --seed 3"
    run(*train.split(), *small.split())
    run(*"train RemedyRushLevel1 --frames 512 --eval-every 0 --out runs/unjudged".split(), *small.split())
    (tmp_path / "runs/random-RemedyRushLevel1-v0-paper.jsonl").write_text(run(*"rollout RemedyRushLevel1 --episodes 3 --json".split()))
    keep = tool("keep_runs").main
    keep([str(tmp_path / "runs"), str(tmp_path / "copies"), "--hasard", hasard, "--agents", "3"])
    copy = tmp_path / "copies/one/seed3"
    assert (copy / "selected.agent").stat().st_size > 1000
    assert not (tmp_path / "copies/unjudged").exists()
    assert 3 < len((copy / "metrics.jsonl").read_text().splitlines()) <= 105
    tables = [run("report", folder, "-o", f"{folder}_report") and (tmp_path / f"{folder}_report/report.md").read_text() for folder in ("runs", "copies")]
    selected = [table.split("## Selected checkpoints")[1].split("\n## ")[0] for table in tables]
    assert "PPOPID" in selected[0] and selected[0] == selected[1]
    # A second time nothing is done again.
    before = (copy / "config.json").stat().st_mtime_ns
    keep([str(tmp_path / "runs"), str(tmp_path / "copies")])
    assert (copy / "config.json").stat().st_mtime_ns == before


def test_the_published_trainer_is_timed_once_warm_and_only_where_it_lasts():
    trainer = tool("beside_published_trainer")
    line = "[2026-11-25 21:09:{:02},500][14957] Fps is (10 sec: 0.0). Total num frames: {}. Throughput: 0: 2.0.\n"
    frames = {0: 0, 5: 0, 10: 4096, 15: 9000, 20: 20_000, 25: 30_000, 30: 40_000, 35: 50_000}
    rows = list(trainer.reports(["another line\n", *(line.format(second, count) for second, count in frames.items())]))
    assert [count for _, count in rows] == list(frames.values()) and rows[1][0] - rows[0][0] == 5
    # Frames begin at second 10; from 20, ten seconds later, 20,000 frames in ten seconds.
    assert trainer.rate_after(rows, 10, 10) == 2000
    assert trainer.rate_after(rows, 10, 60) is None
    assert trainer.rate_after(rows[:2], 10, 10) is None


@pytest.fixture
def hasard():
    program = shutil.which("hasard") or Path(sys.executable).with_name("hasard")
    assert Path(program).exists(), "the package brings the program"
    return str(program)


def campaign(folder, hasard, earned, **env):
    """Runs of PPO, PPOPID and PPOLag on one environment: PPO returns 12, random play 2; costs are half the budget but PPO's."""
    for algorithm, returns in {"PPO": [12.0] * 3, **earned}.items():
        for seed, one in enumerate(returns):
            run = folder / f"RemedyRushLevel1-v0/{algorithm}/{len(env)}/seed{seed}"
            run.mkdir(parents=True)
            cost = 10.0 if algorithm == "PPO" else 2.5
            constraints = [{"term": None, "budget": 5.0}]
            options = {"id": "RemedyRushLevel1-v0", "rules": "paper", **env}
            config = {"env": options, "algorithm": algorithm, "seed": seed, "frames": 1000, "constraints": constraints}
            earned_by, spent = ({"mean": mean, "half_width": half, "bootstrap": None} for mean, half in ((one, 0.1), (cost, 0.5)))
            last = {"frames": 1000, "episodes": 200, "episode_return": earned_by, "cost": spent, "length": spent}
            (run / "config.json").write_text(json.dumps(config))
            (run / "selected.json").write_text(json.dumps({"frames": 1000, "closing": None, "last": last}))
            (run / "metrics.jsonl").write_text(json.dumps({"frames": 1000, "return_mean": 99.0, "cost_mean": 1.0}) + "\n")
    rows = [
        {"env": "RemedyRushLevel1-v0", "rules": "paper", "episode": k, "seed": k, "return": value, "cost": 1.0, "length": 525}
        for k, value in enumerate((1.0, 2.0, 3.0))
    ]
    (folder / "random-RemedyRushLevel1-v0-paper.jsonl").write_text("\n".join(map(json.dumps, rows)))
    return tool("campaign_runs").Campaign(folder, hasard)


@pytest.mark.parametrize(
    ("earned", "state", "difference"),
    [
        # Student's t: each side has a half-width of 0.2484, as there is one environment.
        ({"PPOPID": [9.0, 8.0, 10.0], "PPOLag": [4.0, 5.0, 3.0]}, "holds", "0.50, 0.15 to 0.85"),
        ({"PPOPID": [4.0, 5.0, 3.0], "PPOLag": [9.0, 8.0, 10.0]}, "the contrary holds", "-0.50, -0.85 to -0.15"),
        ({"PPOPID": [4.0, 9.0, 3.0], "PPOLag": [9.0, 3.0, 4.0]}, "not decided", "0.00"),
        ({"PPOPID": [9.0], "PPOLag": [4.0]}, "open: one seed has no interval", "0.50"),
    ],
)
def test_a_hypothesis_of_the_campaign_is_answered_with_an_interval(tmp_path, hasard, earned, state, difference):
    """By hand: returns of 4 and 9 are 0.2 and 0.7 of the way from random play's 2 to PPO's 12."""
    runs = campaign(tmp_path, hasard, earned)
    answers = tool("campaign_answers")
    found, text, seeds = answers.h1(runs)
    assert found == state, text
    assert f"IQM of the difference {difference}" in text
    assert seeds == set(range(len(earned["PPOPID"])))
    found, text, _ = answers.h2(runs)
    assert "over in 1 of 1" in text and found == "open"
    assert answers.h5(runs)[0] == answers.h6(runs)[0] == answers.h7(runs)[0] == "open"


def test_inputs_are_compared_on_one_scale(tmp_path, hasard):
    """An agent that sees depth as well scores on the scale of PPO that sees colours alone."""
    campaign(tmp_path, hasard, {"PPO": [22.0] * 3, "PPOPID": [9.0] * 3}, observation="rgb+depth")
    runs = campaign(tmp_path, hasard, {"PPOPID": [7.0] * 3})
    env = "RemedyRushLevel1-v0"
    scale = runs.scale(env, {0, 1, 2})
    assert scale == (2.0, 12.0)
    assert [run.feasible(scale) for run in runs.of("PPOPID", env)] == [0.5] * 3
    assert [run.feasible(scale) for run in runs.of("PPOPID", env, observation="rgb+depth")] == [0.7] * 3


def test_the_report_scores_as_the_campaign_does(tmp_path, hasard):
    """Also below random play's return: within the budget that is less than a breach, whose score is 0."""
    runs = campaign(tmp_path, hasard, {"PPOPID": [9.0, 8.0, 1.0], "PPOLag": [4.0, 5.0, 3.0]})
    subprocess.run([hasard, "report", tmp_path, "-o", tmp_path / "out"], check=True, capture_output=True)
    rows = {row["directory"]: row["feasible_score"] for row in csv.DictReader((tmp_path / "out/runs.csv").read_text().splitlines())}
    scale = runs.scale("RemedyRushLevel1-v0", {0, 1, 2})
    scores = [run.feasible(scale) for run in runs.of("PPOPID", "RemedyRushLevel1-v0")]
    assert scores == [0.7, 0.6, -0.1]
    reported = [float(score) for directory, score in sorted(rows.items()) if "PPOPID" in directory]
    assert reported == pytest.approx(scores)


def test_a_seed_that_is_not_whole_moves_no_answer(tmp_path, hasard):
    answers = tool("campaign_answers")
    earned = {"PPOPID": [9.0, 8.0, 10.0], "PPOLag": [4.0, 5.0, 3.0]}
    before = answers.h1(campaign(tmp_path / "whole", hasard, earned))
    # A fourth seed of PPO would halve its mean, and of PPOPID raise its own.
    after = answers.h1(campaign(tmp_path / "part", hasard, {**earned, "PPO": [12.0] * 3 + [-12.0], "PPOPID": [9.0, 8.0, 10.0, 90.0]}))
    assert before == after


def test_runs_of_another_study_and_a_seed_twice_end_the_tools(tmp_path, hasard):
    folder = tmp_path / "runs"
    campaign(folder, hasard, {"PPOPID": [9.0, 8.0]})
    config = folder / "RemedyRushLevel1-v0/PPOPID/0/seed1/config.json"
    text = config.read_text()
    # The report itself takes longer runs for another experiment, and one of them alone for a seed.
    for old, new, words in (('"frames": 1000', '"frames": 12000', "12000"), ('"paper"', '"tables"', "tables"), ('"seed": 1', '"seed": 0, "x": 1', "a seed is there twice")):
        config.write_text(text.replace(old, new))
        with pytest.raises(SystemExit, match=words):
            tool("campaign_answers").h1(tool("campaign_runs").Campaign(folder, hasard))


def test_intervals_of_means_are_student_s():
    """By hand: 1, 2, 3 have a mean of 2, a deviation of 1 and two degrees of freedom: 4.303 / sqrt(3) to each side."""
    runs = tool("campaign_runs")
    assert runs.student([1.0, 2.0, 3.0]) == pytest.approx((2 - 2.4843, 2 + 2.4843), abs=1e-3)
    assert runs.student([0.0] * 100 + [1.0] * 100)[0] == pytest.approx(0.5 - 1.97196 * 0.5012547 / 200**0.5, abs=1e-5)
    # The root of the sum of the squares of both half-widths.
    low, high = runs.difference_of_means([1.0, 2.0, 3.0], [6.0, 7.0, 8.0])
    assert (low, high) == pytest.approx((-5 - 3.5133, -5 + 3.5133), abs=1e-3)


def test_the_tables_of_the_campaign_are_of_whole_seeds(tmp_path, hasard):
    page = tool("campaign_page")
    runs = campaign(tmp_path, hasard, {"PPOPID": [9.0, 8.0], "PPOLag": [4.0, 5.0, 3.0]})
    text, seeds = page.of_level(runs, 1, ("PPO", "PPOLag", "PPOPID"))
    # PPOPID has two of the three seeds, and so has the table.
    assert seeds == [0, 1]
    assert text.splitlines()[2:] == [
        "| PPO | 12.00 @ 10.00 (0/2) |",
        "| PPOLag | 4.50 @ 2.50 (2/2) |",
        "| PPOPID | **8.50 @ 2.50** (2/2) |",
        "| random | 2.00 @ 1.00 |",
    ]
    assert page.filled("a\n<!-- table: x -->\nold\n<!-- end -->\nb", {"x": "new"}) == "a\n<!-- table: x -->\n\nnew\n\n<!-- end -->\nb"
    with pytest.raises(SystemExit, match="asks for a table 'y'"):
        page.filled("<!-- table: y --><!-- end -->", {"x": "new"})


def test_the_page_of_the_campaign_is_what_its_runs_make(hasard):
    page, results = tool("campaign_page"), ROOT / "docs/results"
    text = (results / "campaign.md").read_text()
    assert text.count("<!-- table: ") > 3
    made = page.blocks(tool("campaign_runs").Campaign(results / "campaign", hasard))
    assert page.filled(text, made) == text, "run tools/campaign_page.py"


def test_the_middle_half_is_rliable_s():
    iqm = tool("campaign_runs").iqm
    # Of four the middle two; a quarter of six, rounded down, is one.
    assert iqm([100.0, 1.0, 3.0, -50.0]) == 2.0
    assert iqm([0.0, 2.0, 3.0, 5.0, 9.0, 99.0]) == (2 + 3 + 5 + 9) / 4


def test_two_sets_of_runs_are_scored_beside_each_other(tmp_path: Path) -> None:
    """Scores by hand: PPO returns 11 and random play 1, so 6 is 0.5 and 11 is 1; over the budget by the interval's end it is 0."""

    def run(folder: str, seed: int, returned: float, cost: float, high: float | None = None) -> None:
        path = tmp_path / folder / f"seed{seed}"
        path.mkdir(parents=True)
        algorithm = "PPO" if folder.startswith("ppo") else "PPOPID"
        env = {"id": "A-v0", "rules": "paper", "hard": False, "full_actions": False}
        config = {"algorithm": algorithm, "env": env, "seed": seed, "constraints": [{"budget": 5.0}]}
        (path / "config.json").write_text(json.dumps(config))
        ends = None if high is None else [0.0, high]
        closing = {"episode_return": {"mean": returned}, "cost": {"mean": cost, "half_width": 0.5, "bootstrap": ends}}
        last = {**closing, "cost": {"mean": cost / 2, "half_width": 0.5, "bootstrap": None}}
        (path / "selected.json").write_text(json.dumps({"closing": closing, "last": last}))

    (tmp_path / "random-A-v0-paper.jsonl").write_text('{"return":0.5,"cost":1}\n{"return":1.5,"cost":1}\n')
    run("ppo", 1, 11.0, 50.0)
    run("old", 1, 6.0, 4.0)
    run("old", 2, 6.0, 4.6)
    run("old", 3, 6.0, 4.0)
    run("new", 1, 11.0, 4.5)
    run("new", 2, 6.0, 4.0, high=4.9)
    scored = tool("quick_old_new")
    scales = scored.scales_of(tmp_path / "ppo", tmp_path)
    assert scales == {"A-v0": (1.0, 11.0)}
    with pytest.raises(SystemExit, match="the scale is PPO's"):
        scored.scales_of(tmp_path / "old", tmp_path)
    text = scored.table(scored.runs_of(tmp_path / "old"), scored.runs_of(tmp_path / "new"), scales)
    assert "| ALevel" not in text and "| A | 1, 2 | 6.0 @ 4.3 (1/2) | 0.25 | 8.5 @ 4.2 (2/2) | 0.75 |" in text
    assert "Mean feasible score 0.25 and 0.75, a ratio of 3.00, 2.00 to inf" in text
    second = "A-v0", 2
    assert (scored.runs_of(tmp_path / "old")[second], scored.runs_of(tmp_path / "old", last=True)[second]) == (
        (6.0, 4.6, False),
        (6.0, 2.3, True),
    )
