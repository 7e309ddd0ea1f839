//! Coordinates of a lobe: azimuth about its pole and distance from it in the plane q = n beta of one side.
//!
//!     integral of g dw = integral of g x dx dpsi / (n^2 |cos|)      q = q0 + x (cos psi, sin psi)
//!
//! Along every azimuth x goes by its logarithm near the pole and by a square root at the horizon, where 1/|cos| is singular; about
//! the normal by the polar angle. Around, the middles of equal parts of a turn: of a smooth periodic function their sum is the integral.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};
use straylight::math::quadrature::GaussLegendre;
use straylight::optics::Incidence;

/// What a lobe is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pole {
    Specular,
    /// The same, of light that is refracted after it is scattered: what passes goes no farther than grazing light is bent.
    Bent,
    Normal,
    /// The normal, of a function on a grid about it: 0.25 deg are a part of every sector of it.
    Grid,
}

/// Azimuths of lobes in general, and on a grid.
const TURNS: [usize; 2] = [360, 1440];

/// ln of the horizon's distance over the least that is told apart.
const DECADES: f64 = 27.0;

/// One side of the surface about a pole.
#[derive(Clone, Copy, Debug)]
pub struct Polar {
    /// Sign of z.
    pub side: f64,
    n: f64,
    /// The horizon in q.
    reach: f64,
    pole: DVec2,
    /// True about the normal.
    wide: bool,
    turns: usize,
}

impl Polar {
    /// Both sides; beyond the horizon there is no pole, and the normal takes its place.
    pub fn sides(at: &Incidence, pole: Pole) -> [Polar; 2] {
        let along = at.wi.truncate() * at.index[0].re;
        let middle = match pole {
            Pole::Specular | Pole::Bent => -along,
            Pole::Normal | Pole::Grid => DVec2::ZERO,
        };
        let [here, beyond] = at.index.map(|n| n.re);
        let bent = if pole == Pole::Bent { here.min(beyond) } else { beyond };
        [(1.0, here, here), (-1.0, beyond, bent)].map(|(side, n, reach)| {
            let wide = matches!(pole, Pole::Normal | Pole::Grid) || middle.length() >= reach;
            let turns = TURNS[usize::from(pole == Pole::Grid)];
            Polar { side, n, reach, pole: if wide { DVec2::ZERO } else { middle }, wide, turns }
        })
    }

    /// Distance from the pole and azimuth (turns, 0..1) of a direction.
    pub fn place(&self, wo: DVec3) -> [f64; 2] {
        let d = wo.truncate() * self.n - self.pole;
        [d.length(), (d.y.atan2(d.x) / TAU).rem_euclid(1.0)]
    }

    /// The ways from the pole to the horizon in the middles of equal parts of the turn.
    pub fn rays(&self) -> impl Iterator<Item = Ray<'_>> {
        (0..self.turns).map(|k| self.ray((k as f64 + 0.5) / self.turns as f64))
    }

    /// The way from the pole to the horizon at an azimuth (turns).
    fn ray(&self, turn: f64) -> Ray<'_> {
        let towards = DVec2::from_angle(TAU * turn);
        let along = self.pole.dot(towards);
        let beyond = (self.reach - self.pole.length()) * (self.reach + self.pole.length());
        let root = (along * along + beyond).sqrt();
        // Of the two forms that without a difference.
        let end = if along > 0.0 { beyond / (along + root) } else { root - along };
        Ray { polar: self, towards, end }
    }

    /// Integral of `g` dw over this side, g per sr.
    pub fn integral(&self, rule: &GaussLegendre, panels: usize, g: &dyn Fn(DVec3) -> f64) -> f64 {
        let width = 2.0 / panels as f64;
        let along = |ray: Ray| -> f64 {
            (0..panels).map(|k| rule.integrate(width * k as f64, width * (k + 1) as f64, |u| ray.flux(u, g))).sum()
        };
        self.rays().map(along).sum::<f64>() * TAU / self.turns as f64
    }
}

/// Points of quadrature in a panel, and panels along an azimuth: of a smooth function, and of one with kinks.
pub const SMOOTH: [usize; 2] = [10, 32];
pub const KINKED: [usize; 2] = [4, 120];

/// Integral of `g` dw over both sides, g per sr.
pub fn integral(at: &Incidence, pole: Pole, [points, panels]: [usize; 2], g: &dyn Fn(DVec3) -> f64) -> f64 {
    let rule = GaussLegendre::new(points);
    Polar::sides(at, pole).iter().map(|polar| polar.integral(&rule, panels, g)).sum()
}

/// One azimuth. Its coordinate u goes from 0 at the pole to 2 at the horizon.
pub struct Ray<'a> {
    polar: &'a Polar,
    towards: DVec2,
    /// x at the horizon.
    end: f64,
}

impl Ray<'_> {
    /// x and dx/du at `u`.
    fn distance(&self, u: f64) -> [f64; 2] {
        let half = 0.5 * self.end;
        if self.polar.wide {
            let (sin, cos) = (FRAC_PI_4 * u).sin_cos();
            [self.end * sin, self.end * FRAC_PI_4 * cos]
        } else if u < 1.0 {
            let x = half * (DECADES * (u - 1.0)).exp();
            [x, DECADES * x]
        } else {
            let v = half.sqrt() * (2.0 - u);
            [self.end - v * v, 2.0 * v * half.sqrt()]
        }
    }

    /// u at `x`, 0..2.
    pub fn coordinate(&self, x: f64) -> f64 {
        let part = (x / self.end).min(1.0);
        if self.polar.wide {
            2.0 * part.asin() / FRAC_PI_2
        } else if part < 0.5 {
            (1.0 + (2.0 * part).ln() / DECADES).max(0.0)
        } else {
            2.0 - (2.0 * (1.0 - part)).sqrt()
        }
    }

    /// g dw / (du dpsi).
    pub fn flux(&self, u: f64, g: &dyn Fn(DVec3) -> f64) -> f64 {
        let ([x, slope], n) = (self.distance(u), self.polar.n);
        let q = self.polar.pole + self.towards * x;
        let z = ((n - q.length()) * (n + q.length())).max(1e-300).sqrt() / n;
        x * slope * g((q / n).extend(self.polar.side * z)) / (n * n * z)
    }
}

/// Hands every small cell's middle and the integral of `g` dw over it to `sum`; rings even in theta, sectors in phi. Exact for tables:
/// g / cos(theta) is bilinear in (sin^2 theta, phi) on cells whose edges are among those of the small cells.
pub fn small_cells([rings, sectors]: [i32; 2], g: &dyn Fn(DVec3) -> f64, mut sum: impl FnMut(DVec3, f64)) {
    let edge = |k: i32| (FRAC_PI_2 * f64::from(k) / f64::from(rings)).sin().powi(2);
    for ring in 0..rings {
        let (from, to) = (edge(ring), edge(ring + 1));
        let (square, area) = (0.5 * (from + to), 0.5 * (to - from) * TAU / f64::from(sectors));
        let (radius, z) = (square.sqrt(), (1.0 - square).sqrt());
        for sector in 0..sectors {
            let (sin, cos) = (TAU * (f64::from(sector) + 0.5) / f64::from(sectors)).sin_cos();
            let wo = DVec3::new(radius * cos, radius * sin, z);
            sum(wo, g(wo) / z * area);
        }
    }
}
