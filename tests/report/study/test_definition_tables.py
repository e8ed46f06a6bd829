from fake_inputs import definitions

from blockshake.report.study.definition_tables import definition_blocks


def test_stiffness_by_definition_and_what_it_does_are_those_of_the_file():
    _, words, by_definition, free = definition_blocks(definitions())
    assert by_definition.rows[0] == ("0.1", "50 %", "9", "9", "5374", "5374", "201.3", "180.8")
    assert by_definition.rows[1][2] == "none"
    assert by_definition.rows[3][2:4] == ("54", "18")
    # at the study's damping 1 and 3 times the study's own, over levels and dampings 0.5 and 1
    assert "is 1.00 to 3.00 times that of the study" in words.text
    assert "and 0.50 to 1.00 times over the levels" in words.text
    assert "between 150.7 and 302.1 mm" in words.text
    assert "No trend of the peak with the stiffness is shown (Kendall's tau 0.33, p = 1)" in words.text
    assert "is 11.4 % of the shear wave speed of the material, 2447 m/s" in free.caption
    assert free.rows == (("1", "2447", "278.1"), ("10", "7739", "276.1"))
