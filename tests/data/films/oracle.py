"""Amplitudes of stacks by the PyPI package tmm 0.2.0 (S. Byrnes, MIT licence): python3 oracle.py > expected.json

Angles in the first medium, deg; wavelengths and thicknesses in nm; n + ik, exp(-i omega t). r_s, r_p and the phases of t are
tmm's own; T is its power transmittance.
"""
import json
from cmath import phase
from math import radians

import tmm

INF = float("inf")


def values(layers, wavelengths, angles):
    n = [complex(*layer["index"]) for layer in layers]
    d = [layer["thickness_nm"] if layer["thickness_nm"] is not None else INF for layer in layers]
    found = []
    for wavelength in wavelengths:
        for angle in angles:
            row = {"lambda_nm": wavelength, "theta_deg": angle}
            for pol in "sp":
                c = tmm.coh_tmm(pol, n, d, radians(angle), wavelength)
                row |= {f"r{pol}": [c["r"].real, c["r"].imag], f"R{pol}": c["R"], f"T{pol}": c["T"], f"arg_t{pol}": phase(c["t"])}
            found.append(row)
    return found


def layer(n, k=0.0, d=None):
    return {"index": [n, k], "thickness_nm": d}


H, L, GREEN = 2.30, 1.46, 550.0
high, low = layer(H, 0.0, GREEN / 4 / H), layer(L, 0.0, GREEN / 4 / L)
lossy = layer(H, 2e-4, GREEN / 4 / H)
STACKS = {
    "mirror of 25 quarter waves": [layer(1.0)] + [high, low] * 12 + [high, layer(1.5168)],
    "the same with a loss, from the glass": [layer(1.5168)] + [lossy, low] * 12 + [lossy, layer(1.0)],
    "antireflection coating of three layers": [
        layer(1.0), layer(1.38, 0.0, 99.64), layer(2.1, 0.0, 130.95), layer(1.62, 0.0, 84.88), layer(1.7)],
    "20 nm of aluminium under 80 nm of SiO": [layer(1.0), layer(1.55, 0.0, 80.0), layer(0.96, 6.69, 20.0), layer(1.5168)],
    "50 nm of silver on a prism, from the glass": [layer(1.5168), layer(0.06, 3.597, 50.0), layer(1.0)],
    "chromium between glasses": [layer(1.52), layer(3.17, 3.33, 12.0), layer(1.62)],
}

print(json.dumps([
    {"name": name, "layers": layers, "values": values(layers, [450.0, 550.0, 700.0], [0, 10, 30, 40, 43, 50, 60, 75, 85, 89])}
    for name, layers in STACKS.items()
], indent=1))
