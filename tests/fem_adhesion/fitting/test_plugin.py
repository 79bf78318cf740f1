"""The fit model for nanite: loaded as nanite loads it, and fitted to a curve as nanite fits it."""

import sys

import numpy as np
import pytest

from fem_adhesion.fitting import plugin
from halfspace import atlas
from halfspace.errors import InputError
from halfspace.scaling import Units, contact_modulus

POISSON, STIFFNESS = 0.3, 0.5
UNITS = Units(2e-6, contact_modulus(5e6, POISSON), 0.02, 1e-9)  # a soft sphere, tabor 9
CONTACT_POINT, BASELINE = 300e-9, 2e-10


@pytest.fixture
def module(tmp_path):
    nanite_model = pytest.importorskip("nanite.model", reason="nanite brings scikit-learn, too much for dev")
    path = tmp_path / "adhesion_model.py"
    plugin.write(path, radius=2e-6, modulus=3e6, poisson=POISSON)
    yield nanite_model.load_model_from_file(path, register=True)
    sys.modules.pop("adhesion_model")


@pytest.fixture
def indentation(tmp_path):
    """A retract of the atlas, in the format of afmformats."""
    afmformats = pytest.importorskip("afmformats")
    nanite = pytest.importorskip("nanite")
    curve = atlas.curve(UNITS.tabor)
    first, last = curve.branches("approach")["contact"]
    approach = np.linspace(first, last, 400)
    contact = curve.at(approach=approach, branch="contact").load
    apart = np.linspace(first - 100, first, 100, endpoint=False)
    alpha = np.concatenate([apart, approach])
    noise = np.random.default_rng(1).normal(size=2 * alpha.size) * 1e-3 * UNITS.load
    force = UNITS.load * np.concatenate([np.zeros(100), contact])
    force = np.concatenate([force, force[::-1]]) + noise + BASELINE
    tip = CONTACT_POINT - UNITS.spacing * np.concatenate([alpha, alpha[::-1]])
    data = {"force": force, "height (measured)": tip - force / STIFFNESS}
    data["segment"] = np.repeat(np.array([0, 1], np.uint8), alpha.size)
    meta = {"spring constant": STIFFNESS, "imaging mode": "force-distance", "enum": 0, "path": tmp_path / "none"}
    made = afmformats.AFMForceDistance(data, meta)
    made.export_data(tmp_path / "curve.tab", fmt="tab", metadata=["spring constant", "imaging mode", "enum"])
    return nanite.load_group(tmp_path / "curve.tab")[0]


def test_nanite_fits_the_work_of_adhesion_of_a_retract(module, indentation):
    params = module.get_parameter_defaults()
    params["contact_point"].set(CONTACT_POINT + 5e-9)
    params["eps"].set(UNITS.spacing)
    indentation.apply_preprocessing(["compute_tip_position"])
    indentation.fit_model(model_key=module.model_key, params_initial=params, segment=1, weight_cp=0)
    fitted = indentation.fit_properties["params_fitted"]
    assert fitted["dgamma"].value == pytest.approx(UNITS.work_of_adhesion, rel=5e-3)
    assert fitted["E"].value == pytest.approx(5e6, rel=5e-3)
    assert fitted["contact_point"].value == pytest.approx(CONTACT_POINT, abs=0.1 * UNITS.spacing)


def test_the_model_is_the_atlas_in_contact(module):
    approach = np.linspace(-2.0, 10.0, 50)
    delta = CONTACT_POINT - UNITS.spacing * approach
    force = module.module.model_func(delta, 5e6, 2e-6, POISSON, 0.02, 1e-9, CONTACT_POINT, BASELINE)
    load = atlas.curve(UNITS.tabor).at(approach=approach, branch="contact").load
    assert force == pytest.approx(UNITS.load * load + BASELINE, abs=2e-3 * UNITS.load)


@pytest.mark.parametrize("name", ["a model.py", "model.txt", "2.py"])
def test_a_name_that_cannot_be_imported_is_refused(name, tmp_path):
    with pytest.raises(InputError, match="rename it"):
        plugin.write(tmp_path / name, radius=1e-6, modulus=1e6, poisson=0.3)
    assert not list(tmp_path.iterdir())
