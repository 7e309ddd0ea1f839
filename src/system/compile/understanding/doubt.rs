//! Doubts that need the whole scene: sizes, energy, data ranges, contradictions where faces touch, sources in walls.

use super::beam::births;
use super::budget::{share, uses};
use super::contact::{around, closed, contacts};
use crate::detector::Place;
use crate::error::Problem;
use crate::geometry::Hit;
use crate::scene::{Filling, PartKind, Scene};
use crate::system::compile::assembly::Assembly;
use crate::system::compile::lights::Light;
use crate::system::document::Document;
use glam::DVec3;
use num_complex::Complex64;
use std::collections::BTreeSet;

/// Largest dimensions of scenes that nobody would doubt, m.
const SIZES: [f64; 2] = [1e-4, 100.0];
/// Files of one scene whose sizes differ by more than this factor are doubted.
const DISPARITY: f64 = 1000.0;
/// Albedo of a table or a radial integral beyond 1 that is its rounding.
const ROUNDING: f64 = 1e-6;

/// All of them, errors and warnings.
pub(in crate::system::compile) fn doubts(
    scene: &Scene,
    assembly: &Assembly,
    document: &Document,
    lights: &[Light],
) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut note = |path: &str, problem: Problem| problems.push(document.problem(path, problem));
    sizes(assembly, &mut note);
    ranges(scene, document, lights, &mut note);
    energy(scene, document, lights, &mut note);
    contradictions(scene, &mut note);
    enclosed(scene, assembly, &mut note);
    problems
}

type Note<'a> = &'a mut dyn FnMut(&str, Problem);

/// Files whose unit looks wrong.
fn sizes(assembly: &Assembly, note: Note) {
    let files: BTreeSet<usize> = assembly.file_of.iter().copied().flatten().collect();
    let size = |of: Option<usize>| {
        let nodes =
            assembly.nodes.iter().zip(&assembly.file_of).filter(|(_, file)| of.is_none_or(|of| **file == Some(of)));
        let boxes = nodes.filter_map(|(node, _)| node.mesh.bounds());
        let whole = boxes.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        whole.map_or(0.0, |[low, high]| (high - low).max_element())
    };
    let all = size(None);
    let hint = "glTF lengths are in metres; say `unit: \"mm\"` for a file in millimetres".to_owned();
    if all > 0.0 && !(SIZES[0]..=SIZES[1]).contains(&all) {
        let problem = Problem::warning(format!("the scene is {all:.3e} m large: the unit may be wrong"));
        note("geometry[0].unit", problem.hinting(hint.clone()));
    }
    let measured: Vec<(usize, f64)> = files.iter().map(|&file| (file, size(Some(file)))).collect();
    let extreme = |larger: fn(f64, f64) -> bool| {
        measured.iter().copied().reduce(|best, next| if larger(next.1, best.1) { next } else { best })
    };
    if let (Some((least, small)), Some((_, large))) = (extreme(|a, b| a < b), extreme(|a, b| a > b))
        && small > 0.0
        && large > DISPARITY * small
    {
        let what = format!("this file is {small:.3e} m large, another one {large:.3e} m: a unit may be wrong");
        note(&format!("geometry[{least}].unit"), Problem::warning(what).hinting(hint));
    }
}

/// Media that light meets, with data that end before the sources' wavelengths do.
fn ranges(scene: &Scene, document: &Document, lights: &[Light], note: Note) {
    let mut used: BTreeSet<u16> = uses(scene).into_iter().flat_map(|(_, media)| media).collect();
    let coated = document.system.coatings.iter().flat_map(|(_, coating)| coating.media());
    let place = |name: &str| scene.media.iter().position(|filling| filling.label == *name);
    used.extend(coated.filter_map(place).map(|medium| medium as u16));
    for filling in used.iter().map(|&medium| &scene.media[medium as usize]) {
        for problem in lights.iter().filter_map(|light| uncovered(filling, light)) {
            note(&format!("media[{:?}]", filling.label), problem);
        }
    }
}

/// What the data of a medium lack of some light.
fn uncovered(filling: &Filling, light: &Light) -> Option<Problem> {
    let (medium, label, light) = (&filling.medium, &light.label, light.range);
    let nanometres = |m: f64| format!("{} nm", (m * 1e10).round() / 10.0);
    let span = |[from, to]: [f64; 2]| format!("{} to {}", nanometres(from), nanometres(to));
    let beyond = |[low, high]: &[f64; 2]| light[0] < low * (1.0 - ROUNDING) || light[1] > high * (1.0 + ROUNDING);
    let lit = format!("the light of `{label}`: {}", span(light));
    if let Some(range) = medium.range().filter(beyond) {
        let what = format!("the data of `{}` do not cover {lit}", filling.label);
        return Some(Problem::error(what).expecting(format!("wavelengths from {}", span(range))));
    }
    let valid = |n: Complex64| n.re.is_finite() && n.im.is_finite() && (n.re > 0.0 || n.im > 0.0);
    let tried = [light[0], 0.5 * (light[0] + light[1]), light[1]];
    if let Some(bad) = tried.into_iter().find(|&wavelength| !valid(medium.index(wavelength))) {
        return Some(Problem::error(format!("`{}` has no index at {}", filling.label, nanometres(bad))));
    }
    let table = medium.absorption_range().filter(beyond)?;
    let hint = format!("it is known from {} and keeps its end value beyond", span(table));
    let what = format!("the absorption of `{}` is not known for all of {lit}", filling.label);
    Some(Problem::warning(what).hinting(hint))
}

/// Surfaces that send off more than arrives, at 0, 5, .., 85 deg and at grazing incidence.
fn energy(scene: &Scene, document: &Document, lights: &[Light], note: Note) {
    let ranges = lights.iter().flat_map(|light| light.range);
    let mut wavelengths: Vec<f64> = ranges.collect();
    wavelengths.sort_by(f64::total_cmp);
    wavelengths.dedup();
    let mut told = BTreeSet::new();
    for (index, media) in uses(scene) {
        let surface = &scene.surfaces[index as usize];
        let angles = || (0..=17).map(|step| 5.0 * f64::from(step)).chain([87.5, 89.0, 89.9]);
        let at = wavelengths.iter().flat_map(|w| angles().map(move |degrees| (*w, degrees)));
        let excess = |(wavelength, degrees): (f64, f64)| {
            let share = share(scene, surface, media, degrees.to_radians(), wavelength);
            // A scattered part above 1 makes what is left to the coating negative: count it alone.
            let scattered = share.diffuse + share.spread;
            (-share.absorbed()).max(scattered - 1.0)
        };
        let worst = at.map(|at| (excess(at), at.1)).reduce(|a, b| if b.0 > a.0 { b } else { a });
        if let Some((excess, degrees)) = worst.filter(|(excess, _)| *excess > ROUNDING)
            && told.insert(index)
        {
            let names = document.system.scatter.iter().map(|(name, _)| name);
            let name = names.filter(|name| surface.label.ends_with(&format!("scatter {name}"))).max_by_key(|n| n.len());
            let path = name.map_or("surfaces".into(), |name| format!("scatter[{name:?}]"));
            let what = format!(
                "`{}` sends off {:.4} of the light that arrives at {degrees} deg, {excess:.4} too much",
                surface.label,
                1.0 + excess
            );
            note(&path, Problem::error(what).expecting("specular and scattered light together at most 1"));
        }
    }
}

/// Coincident faces whose declared coatings contradict each other: which one acts would be chance.
fn contradictions(scene: &Scene, note: Note) {
    for (parts, hits) in contacts(scene) {
        let [a, b] = parts.map(|part| &scene.parts[part as usize]);
        if a.air_gap || b.air_gap || [a, b].iter().all(|part| part.kind == PartKind::Sheet) {
            continue;
        }
        let contradict = |turned: bool| {
            let seen = |hit: Hit| scene.part(hit).surface[0][(hit.front == turned) as usize];
            let [one, other] = hits.map(seen);
            let declared = |surface: u32| {
                let surface = &scene.surfaces[surface as usize];
                !surface.opaque() && !surface.is_plain()
            };
            one != other && declared(one) && declared(other)
        };
        if contradict(false) || contradict(true) {
            let [one, other] = [a, b].map(|part| &scene.surfaces[part.surface[0][0] as usize].label);
            let coatings =
                if one == other { "the same coating, which would be there twice" } else { "different coatings" };
            let what = format!("`{}` and `{}` lie on each other with {coatings}", a.label, b.label);
            let problem = Problem::error(what).expecting("a coating on one of the two faces, the other one Fresnel");
            note("surfaces", problem.hinting("or `gap: Air` if they do not touch optically".to_owned()));
        }
    }
}

/// Sources that shine into the inside of something opaque where nobody watches.
fn enclosed(scene: &Scene, assembly: &Assembly, note: Note) {
    const TRIED: u32 = 16;
    let mut opaque = closed(assembly);
    for (triangle, &part) in scene.part_of.iter().enumerate() {
        let part = &scene.parts[part as usize];
        let wall = part.surface[0].iter().all(|&surface| scene.surfaces[surface as usize].opaque());
        opaque[scene.geometry.object(triangle as u32) as usize] &= wall && part.kind == PartKind::Sheet;
    }
    if !opaque.contains(&true) {
        return;
    }
    let watched: BTreeSet<u32> =
        detector_points(scene).flat_map(|(point, on)| around(scene, &opaque, point).into_iter().chain(on)).collect();
    for source in &scene.sources {
        let mut count = vec![0; opaque.len()];
        for birth in births(source, TRIED) {
            let own = birth.from.map(|(triangle, _)| scene.geometry.object(triangle));
            let holders = around(scene, &opaque, birth.ray.origin).into_iter().filter(|&holder| Some(holder) != own);
            holders.for_each(|holder| count[holder as usize] += 1);
        }
        let holder = (0..opaque.len()).find(|&node| 2 * count[node] > TRIED && !watched.contains(&(node as u32)));
        if let Some(node) = holder {
            let name = &assembly.nodes[node].name;
            let what =
                format!("`{}` starts inside `{name}`, which is closed and opaque, without a detector", source.label);
            note(&format!("sources[{:?}].at", source.label), Problem::warning(what));
        }
    }
}

/// A point of each detector (scene coordinates, m), and the node it is on.
fn detector_points(scene: &Scene) -> impl Iterator<Item = (DVec3, Option<u32>)> + '_ {
    let windows = scene.detectors.iter().filter_map(|detector| match &detector.place {
        Place::Window(window) => Some((window.centre, None)),
        Place::Parts | Place::FarField => None,
    });
    let on_parts = scene.parts.iter().enumerate().filter(|(_, part)| !part.detectors.is_empty());
    let triangles = on_parts.filter_map(|(index, _)| scene.part_of.iter().position(|&part| part as usize == index));
    windows.chain(triangles.map(|triangle| {
        let triangle = triangle as u32;
        (scene.geometry.triangle(triangle).centroid(), Some(scene.geometry.object(triangle)))
    }))
}
