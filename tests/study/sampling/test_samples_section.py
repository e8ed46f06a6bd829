from fake_study import MODELS
from page import texts

from blockshake.study.report.content import load_content
from blockshake.study.sampling.section import samples


def test_variables_without_use_are_those_of_the_models_of_the_study(fake):
    study = {**fake.study, "models": {"ls-dem": MODELS["ls-dem"]}}
    said = " ".join(texts(samples(load_content(study, fake.results))))
    assert "LS-DEM has no use for viscous modulus of concrete" in said
    assert "NSCD rigid has no use" not in said
