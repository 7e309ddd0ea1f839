"""Numbers of Optiland (MIT licence, https://pypi.org/project/optiland) for tests/exactness/optiland.rs.

    pip install optiland==0.6.3
    python reference.py > reference.json

Harvey-Shack in Optiland is b0 / (1 + (|beta - beta0| / l0)^s): an ABg of A = b0 l0^s, B = l0^s, g = s. It scatters the share
`scatter_fraction` of the rays, here its own total, times the reflectance; draws beyond the horizon carry nothing.
Its rays are not polarised and its coatings do not know the angle: the coated slab is met along its normal, with R and T of one face
from its thin films.
"""

import json
import math
from importlib.metadata import version

import numpy as np
from optiland.coatings import SimpleCoating
from optiland.coordinate_system import CoordinateSystem
from optiland.materials import IdealMaterial
from optiland.nonsequential import (
    CollimatedSourceConfig,
    FinitePlaneGeometry,
    HarveyShackBSDF,
    NSQMaterial,
    NSQScene,
    Spectrum,
    VACUUM,
)
from optiland.nonsequential.components.reflective import ReflectiveComponent
from optiland.nonsequential.components.refractive import RefractiveComponent
from optiland.nonsequential.detectors.ray_database import RayDatabaseDetector
from optiland.thin_film import ThinFilmStack

RINGS, BATCHES, RAYS = 36, 20, 100_000
REFLECTANCE = 0.9
GLASS, FILM, LINE = 1.5168, 1.38, 0.55


def scene_of(theta):
    scene = NSQScene()
    at = CoordinateSystem(x=-50 * math.sin(theta), z=-50 * math.cos(theta), ry=theta)
    beam = CollimatedSourceConfig(spectrum=Spectrum.monochromatic(LINE), total_flux=1.0, aperture_radius=0.01)
    scene.add_source("beam", at, beam)
    return scene


def plane(z, radius):
    return CoordinateSystem(z=z), FinitePlaneGeometry(aperture_radius=radius)


def watch(scene, name, z):
    at, geometry = plane(z, 1e9)
    detector = RayDatabaseDetector(at, geometry, name=name)
    scene.detector_registry.add(name, detector)
    return detector


def mean_and_error(rows):
    rows = np.array(rows)
    mean, error = rows.mean(axis=0), rows.std(axis=0, ddof=1) / math.sqrt(len(rows))
    return mean.tolist(), error.tolist()


def mirror(degrees, b0, l0, s):
    theta = math.radians(degrees)
    haze = HarveyShackBSDF(b0, l0, s)
    fraction = haze.total_integrated_scatter
    rows = []
    for batch in range(BATCHES):
        scene = scene_of(theta)
        at, geometry = plane(0.0, 100.0)
        scene.add_component("mirror", ReflectiveComponent(at, geometry, REFLECTANCE, bsdf=haze, scatter_fraction=fraction))
        watch(scene, "sky", -100.0)
        rays = scene.trace(num_rays=RAYS, seed=batch + 1).detectors["sky"]
        direction = np.stack([rays.L, rays.M, rays.N], axis=1)
        specular = np.array([math.sin(theta), 0.0, -math.cos(theta)])
        angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(direction, specular), axis=1), direction @ specular))
        flux = np.array(rays.flux)
        ring = np.minimum(angle * RINGS / 180.0, RINGS - 1).astype(int)
        scattered = angle > 1e-5
        rows.append(np.bincount(ring[scattered], flux[scattered], minlength=RINGS))
    mean, error = mean_and_error(rows)
    return dict(degrees=degrees, b0=b0, l0=l0, s=s, reflectance=REFLECTANCE, fraction=fraction, flux=mean, error=error)


def film():
    stack = ThinFilmStack(IdealMaterial(1.0), IdealMaterial(GLASS), reference_wl_um=LINE)
    return stack.add_layer_qwot(IdealMaterial(FILM))


def face():
    rows = []
    for degrees in [0, 30, 45, 60, 75]:
        for polarization in "sp":
            found = film().compute_rtRTA(LINE, math.radians(degrees), polarization)
            row = {name: float(np.real(found[name]).ravel()[0]) for name in "RT"}
            rows.append(dict(degrees=degrees, polarization=polarization, **row))
    return rows


def slab():
    found = film().compute_rtRTA(LINE, 0.0, "u")
    r, t = (float(np.real(found[name]).ravel()[0]) for name in "RT")
    coating, glass = SimpleCoating(t, r), NSQMaterial(IdealMaterial(GLASS))
    rows = []
    for batch in range(BATCHES):
        scene = scene_of(0.0)
        for name, z, media in [("front", 0.0, (VACUUM, glass)), ("back", 5.0, (glass, VACUUM))]:
            at, geometry = plane(z, 100.0)
            scene.add_component(name, RefractiveComponent(at, geometry, *media, coating=coating))
        watch(scene, "passed", 50.0)
        watch(scene, "returned", -100.0)
        result = scene.trace(num_rays=RAYS, seed=batch + 1)
        rows.append([float(np.sum(result.detectors[name].flux)) for name in ("passed", "returned")])
    mean, error = mean_and_error(rows)
    return dict(thickness_mm=5.0, passed=mean[0], passed_error=error[0], returned=mean[1], returned_error=error[1])


print(json.dumps(
    dict(
        program="Optiland", version=version("optiland"), licence="MIT", rays=RAYS * BATCHES,
        glass=GLASS, film=FILM, line_um=LINE,
        mirrors=[mirror(0, 3.0, 0.05, 1.8), mirror(40, 4.0, 0.05, 2.0)], face=face(), slab=slab(),
    ),
    indent=1,
))
