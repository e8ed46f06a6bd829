import re

import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.study.sampling.correlation_target import (
    check_correlation,
    load_correlation,
    nearest_correlation,
)


def _write(tmp_path, text):
    path = tmp_path / "target.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_square_csv_is_read_by_its_names(tmp_path):
    path = _write(tmp_path, "name, a, b\na, 1, 0.25\nb, 0.25, 1\n\n")
    frame = load_correlation(path)
    assert list(frame.columns) == list(frame.index) == ["a", "b"]
    np.testing.assert_array_equal(frame.to_numpy(), [[1.0, 0.25], [0.25, 1.0]])
    assert frame.attrs["source"] == str(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "square table"),
        (",a,b\na,1,0\n", "first column"),
        (",a,b\nb,1,0\na,0,1\n", "first column"),
        (",a,a\na,1,0\na,0,1\n", "every name once"),
        (",a,b\na,1,x\nb,0,1\n", "a, b: expected a number, not 'x'"),
        (",a,b\na,1,0_1\nb,0_1,1\n", "a, b: expected a number, not '0_1'"),
        (",a,b\na,1\nb,0,1\n", "expected 2 numbers"),
        (",a,b\na,1,0.2\nb,0.3,1\n", "symmetric"),
        (",a,b\na,0.9,0.2\nb,0.2,1\n", "expected 1 on the diagonal, not 0.9"),
        (",a,b\na,1,1.2\nb,1.2,1\n", "in [-1, 1], not 1.2"),
        (",a,b\na,1,nan\nb,nan,1\n", "a, b: expected a number, not 'nan'"),
        (",a,b\na,1,1\nb,1,1\n", "positive definite"),
    ],
)
def test_a_wrong_target_is_refused_in_one_line(tmp_path, text, words):
    path = _write(tmp_path, text)
    with pytest.raises(InputError, match=re.escape(words)) as error:
        load_correlation(path)
    assert str(error.value).startswith(str(path))
    assert "\n" not in str(error.value)


def test_the_suggestion_in_the_line_is_valid_as_typed():
    names = ["a", "b", "c"]
    matrix = np.array([[1.0, 0.9, 0.9], [0.9, 1.0, -0.9], [0.9, -0.9, 1.0]])
    with pytest.raises(InputError) as error:
        check_correlation(matrix, names, "target.csv")
    typed = np.eye(3)
    for first, second, value in re.findall(r"(\w), (\w): (-?\d\.\d+)", str(error.value)):
        i, j = names.index(first), names.index(second)
        typed[i, j] = typed[j, i] = float(value)
    check_correlation(typed, names, "typed")
    # by symmetry the nearest has the same magnitude everywhere, and 0.5 is the semidefinite limit
    np.testing.assert_allclose(np.abs(typed[np.triu_indices(3, k=1)]), 0.5, atol=1e-3)


def test_nearest_matrix_is_that_of_higham_2002():
    # Higham (2002), section 4: the nearest correlation matrix to this one, to four digits;
    # our floor of 0.001 under the eigenvalues moves entries by at most as much
    matrix = np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]])
    published = np.array([[1.0, 0.7607, 0.1573], [0.7607, 1.0, 0.7607], [0.1573, 0.7607, 1.0]])
    np.testing.assert_allclose(nearest_correlation(matrix), published, atol=1e-3)


def test_a_valid_matrix_is_its_own_nearest():
    matrix = np.array([[1.0, 0.3], [0.3, 1.0]])
    np.testing.assert_allclose(nearest_correlation(matrix), matrix, atol=1e-12)


def test_nearest_of_thirty_variables_stays_valid_with_four_digits():
    drawn = np.random.default_rng(6).uniform(-1.0, 1.0, size=(30, 30))
    matrix = np.triu(drawn, k=1) + np.triu(drawn, k=1).T + np.eye(30)
    check_correlation(np.round(nearest_correlation(matrix), 4), [str(i) for i in range(30)], "rounded")
