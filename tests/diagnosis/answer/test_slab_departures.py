from types import SimpleNamespace

import numpy as np

from blockshake.diagnosis.answer.departures import slab_departures


def test_the_slab_s_motion_stands_beside_that_of_the_likeliest_cause():
    time = np.arange(5) * 0.1
    slabs = [
        SimpleNamespace(time=time, turn=size * time, lift=0.0 * time, at=np.array([1, 3]))
        for size in (1.0, 2.0)
    ]
    tests = [SimpleNamespace(name=name) for name in ("a", "b")]
    rows = [np.array([0.1, 0.3]), np.array([0.2, 0.6])]
    explained = {"table-pitch": SimpleNamespace(rows=rows)}
    part = SimpleNamespace(readings="rotation of the slab", causes=[SimpleNamespace(name="table-pitch")])
    shown = slab_departures(tests, slabs, explained, [part])
    assert shown["slab_test"].values.tolist() == ["a", "a", "b", "b"]
    np.testing.assert_allclose(shown["slab_time"], [0.1, 0.3, 0.1, 0.3])
    np.testing.assert_allclose(shown["turn"], [0.1, 0.3, 0.2, 0.6])
    np.testing.assert_allclose(shown["turn_explained"], shown["turn"])
    assert not shown["lift_explained"].any()
    assert not slab_departures(tests, slabs, explained, [])["turn_explained"].any()
