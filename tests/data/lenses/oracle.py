"""Writes expected.json: first-order data of the lens files beside it, as ray-optics computes them.

    pip install rayoptics==0.9.8
    python oracle.py

At each file's reference wavelength. Lengths in m (file units times the unit that ray-optics read), indices as ray-optics
took them from its catalogues, one per space. `focal_length` is n' / power, so negative for an odd number of mirrors; distances are
along the local z. `vertices` are those of the surfaces in the axes of surface 1, m.
"""

import json
import logging
import shutil
import tempfile
import warnings
from pathlib import Path

warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)

from rayoptics.gui.appcmds import open_model  # noqa: E402

UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254, "inches": 0.0254}
HERE = Path(__file__).parent


def expected(path):
    with tempfile.TemporaryDirectory() as folder:  # ray-optics writes lists of unknown glasses beside the file
        model = open_model(shutil.copy(path, folder))
    model = model[0] if isinstance(model, tuple) else model
    model.update_model()
    sequence, unit = model["seq_model"], UNITS[model["system_spec"].dimensions]
    wavelength = model["optical_spec"]["wvls"].central_wvl
    first = model["analysis_results"]["parax_data"].fod
    return {
        "wavelength": wavelength * 1e-9,
        "materials": [gap.medium.name() for gap in sequence.gaps],
        "indices": [float(gap.medium.rindex(wavelength)) for gap in sequence.gaps],
        "image_index": float(first.n_img),
        "focal_length": first.efl * unit,
        "back_focal_length": first.bfl * unit,
        "front_focal_length": first.ffl * unit,
        "image_distance": first.img_dist * unit,
        "image_height": first.img_ht * unit,
        "entrance_pupil": [first.enp_dist * unit, first.enp_radius * unit],
        "exit_pupil": [first.exp_dist * unit, first.exp_radius * unit],
        "f_number": float(first.fno),
        "vertices": [[float(x) * unit for x in place] for _, place in sequence.gbl_tfrms[1:]],
    }


files = sorted(path for path in HERE.iterdir() if path.suffix in (".zmx", ".seq", ".roa"))
rows = ",\n".join(f"{json.dumps(path.name)}: {json.dumps(expected(path))}" for path in files)
(HERE / "expected.json").write_text("{\n" + rows + "\n}\n")
