//! Some rays of every source, by the tracer that runs use: where light goes, not how much of it.

use crate::geometry::{Left, Ray};
use crate::packet::{Ancestry, Class};
use crate::scene::Scene;
use crate::settings::{Roulette, Settings};
use crate::tally::Live;
use crate::tally::drawing::Way;
use crate::transport::book::Book;
use crate::transport::importance::Importance;
use crate::transport::paths::Rows;
use crate::transport::walk::{Quota, Walk};
use crate::transport::watch::{Sight, Watch};
use glam::DVec3;

/// Points of all ways together; a picture of more is a blot.
const MOST_POINTS: usize = 60_000;
/// Events after which a drawn ray ends.
const MOST_EVENTS: u32 = 64;
/// How far light that leaves the scene is followed, in radii of the scene.
const BEYOND: f64 = 0.3;

/// The ways of `rays` rays of every source. At interfaces one branch is drawn; light that is scattered leaves its specular ray.
pub fn sketch(scene: &Scene, settings: &Settings, rays: u64) -> Vec<Way> {
    let settings = Settings {
        splits: 0,
        scatter_splits: 1,
        roulette: Roulette { below: 1e-4, survive: 0.1 },
        max_events: MOST_EVENTS,
        ..settings.clone()
    };
    let (layout, rows, importance) = (scene.layout(0), Rows::default(), Importance::declared(scene));
    let book = Book::<1>::new(&layout, Live::new(layout.len()), Some(&rows));
    let pen = Pen {
        scene,
        far: BEYOND * scene.geometry.radius(),
        now: None,
        points: Vec::new(),
        flux: 0.0,
        left: MOST_POINTS,
        ways: Vec::new(),
    };
    let quotas: Vec<Quota> = (0..scene.sources.len() as u64).map(|i| Quota { first: i * rays, count: rays }).collect();
    let mut walk = Walk::new(scene, &settings, &importance, book, pen);
    walk.batch(0, &quotas);
    walk.watch.lift();
    walk.watch.ways
}

/// Draws a line for every branch, and another where it becomes light of another class.
struct Pen<'a> {
    scene: &'a Scene,
    /// m
    far: f64,
    /// What is drawn: source, history, class.
    now: Option<(u16, u64, Class)>,
    points: Vec<DVec3>,
    flux: f64,
    /// Points that may still be drawn.
    left: usize,
    ways: Vec<Way>,
}

impl Pen<'_> {
    fn to(&mut self, point: DVec3) {
        if self.points.last() != Some(&point) {
            self.points.push(point);
        }
    }

    /// The line in hand is done.
    fn lift(&mut self) {
        let points = std::mem::take(&mut self.points);
        let Some((source, _, class)) = self.now.filter(|_| points.len() > 1 && points.len() <= self.left) else {
            return;
        };
        self.left -= points.len();
        self.ways.push(Way {
            source: self.scene.sources[source as usize].label.clone(),
            // Light that has met nothing is no leak before it arrives.
            class: if class == Class::Direct { "incoming".into() } else { class.label(self.scene.has_optics) },
            path: None,
            points,
            flux: self.flux,
        });
    }
}

impl Watch for Pen<'_> {
    fn follows(&mut self, ancestry: &Ancestry, _flux: f64) {
        let now = Some((ancestry.source, ancestry.history, ancestry.class()));
        if self.now != now {
            self.lift();
            self.now = now;
        }
    }

    fn flight(&mut self, ray: &Ray, _left: &Left) {
        if self.points.last().is_some_and(|last| *last != ray.origin) {
            // A branch that waited at another place.
            self.lift();
        }
        self.to(ray.origin);
    }

    fn event(&mut self, sight: impl FnOnce() -> Sight) {
        let sight = sight();
        self.flux = sight.flux;
        self.to(sight.point);
    }

    fn scattered(&mut self, ray: &Ray, _medium: u16, flux: f64) {
        self.flux = flux;
        self.to(ray.origin);
    }

    fn escaped(&mut self, ray: Ray, flux: f64) {
        self.flux = flux;
        self.to(ray.origin + self.far * ray.direction);
    }
}
