"""What a matcher learns from says of kept keypoints what geometry says of all, and is computed once."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from experiments.training.data.shards import Shard, write_shard
from experiments.training.matcher import examples
from experiments.training.matcher.examples import ALONE, UNKNOWN, partners_of, read_examples
from experiments.training.matcher.features import extracted, table_of
from experiments.training.matcher.losses import truth_of
from experiments.training.sealed import sealed_files
from experiments.training.worlds import first_worlds
from services.launcher.client.failure import ExperimentError
from tests.unit.experiments.training.places import HIDDEN, in_this_process

MOST = 60


@pytest.fixture(autouse=True)
def _here(monkeypatch):
    monkeypatch.setattr(examples, "workers", in_this_process)


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    return tmp_path_factory.mktemp("kept")


@pytest.fixture
def read(places, kept):
    return read_examples(places.files, "sift", MOST, None, kept, 2)


def all_of(count, pairs=1):
    return torch.arange(count).expand(pairs, -1)


@pytest.mark.parametrize("pair", [(0, 1), (1, 0), (2, 0), (4, 5), (0, 4)])
def test_what_is_right_of_all_keypoints_is_what_geometry_says(places, read, pair):
    chosen = torch.tensor([pair])
    here, there = (read.table.of(side) for side in chosen.T)
    expected = truth_of(places.panoramas, chosen, here, there)
    found = read.truth(chosen, all_of(MOST), all_of(MOST))
    # Keypoints as a map keeps them lie 0.005 degrees off, which moves one across a threshold now and then.
    assert (found.partners != expected.partners).sum() <= 2
    assert bool(expected.partners.any()) == (pair != (0, 4))
    for told, true in zip(found.alone, expected.alone, strict=True):
        assert (told != true).sum() <= 3
    assert float(found.overlap) == pytest.approx(float(expected.overlap), abs=1e-3)
    assert float(found.log_distance) == pytest.approx(float(expected.log_distance), abs=1e-4)


def test_of_kept_keypoints_partners_are_renumbered_and_of_those_without_theirs_nobody_knows(read):
    chosen = torch.tensor([[0, 1], [1, 0]])
    whole = read.truth(chosen, all_of(MOST, 2), all_of(MOST, 2))
    kept = torch.stack([torch.randperm(MOST, generator=torch.Generator())[:40] for _ in range(2)])
    kept_other = torch.stack([torch.randperm(MOST, generator=torch.Generator())[:30] for _ in range(2)])
    some = read.truth(chosen, kept, kept_other)
    for row in range(2):
        expected = whole.partners[row][kept[row]][:, kept_other[row]]
        assert torch.equal(some.partners[row], expected)
        assert torch.equal(some.alone[0][row], whole.alone[0][row][kept[row]])
    assert some.partners.any()
    lost = whole.partners[0][kept[0]].any(1) & ~some.partners[0].any(1)
    assert lost.any()
    assert not some.alone[0][0][lost].any()


def test_what_sees_nothing_of_the_other_leaves_all_alone_and_fillers_are_nobodys(places):
    found = extracted(places.sights[:4], "sift", MOST)
    short = replace(
        found[0],
        **{
            name: getattr(found[0], name)[:20]
            for name in ("lonlat_rad", "scores", "descriptors", "sizes_rad")
        },
    )
    overlap = places.panoramas.overlap[:4, :4].clone()
    overlap[HIDDEN], overlap[:, HIDDEN] = 0.0, 0.0
    first = {name: part[:4] for name, part in vars(places.panoramas).items()}
    alone = replace(places.panoramas, **first | {"overlap": overlap})
    partners = partners_of(alone, table_of([short, *found[1:]], MOST))
    assert (partners[0, HIDDEN, :20] == ALONE).all()
    assert (partners[:, :, 20:][0] == UNKNOWN).all()
    there = partners[0, 1, :20]
    for number, partner in enumerate(there):
        assert partner < 0 or partners[1, 0, partner] == number
    assert (there >= 0).any()


def test_it_is_computed_once_and_what_was_changed_since_is_refused(places, kept, read, monkeypatch):
    monkeypatch.setattr(examples, "trainable", None)
    again = read_examples(places.files, "sift", MOST, None, kept, 1)
    assert torch.equal(again.partners, read.partners)
    assert torch.equal(again.table.descriptors, read.table.descriptors)
    (path,) = sealed_files(kept, places.files[1].stem, ".npz")
    whole = path.read_bytes()
    path.write_bytes(whole[:-9])
    with pytest.raises(ExperimentError, match=r"corrupted.*delete it, which computes it again"):
        read_examples(places.files, "sift", MOST, None, kept, 1)
    path.write_bytes(whole)


def test_shards_without_pairs_are_left_out(places, tmp_path):
    (world,) = first_worlds("development", 1)
    empty = write_shard(tmp_path, "empty", Shard(world, [], {"recipe": {}}), [])
    found = read_examples([empty, places.files[1], empty], "sift", 50, None, tmp_path / "kept", 1)
    assert found.table.present.shape == (2, 50)
    assert found.shard.tolist() == found.begins.tolist() == [0, 0]
    assert found.rows.tolist() == [0, 2]
    assert np.isfinite(found.positions_m.numpy()).all()
    with pytest.raises(ExperimentError, match="draw more with 'topnav train data'"):
        read_examples([empty], "sift", 50, None, tmp_path / "kept", 1)
