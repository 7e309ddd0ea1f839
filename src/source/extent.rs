//! Where light starts. Every extent is sampled uniformly in area (Gaussian: in its irradiance profile).

use crate::geometry::Frame;
use crate::math::sampling;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// The shape of a source.
#[derive(Clone, Debug)]
pub enum Extent {
    /// A flat outline in the xy plane of `frame` about `at` (scene coordinates, m); z is the side it shines to.
    Flat { frame: Frame, at: DVec3, outline: Outline },
    /// Triangles of the scene.
    Mesh(Mesh),
}

/// Flat outlines, m.
#[derive(Clone, Copy, Debug)]
pub enum Outline {
    Point,
    Disk {
        radius: f64,
    },
    Annulus {
        inner: f64,
        outer: f64,
    },
    /// Regular polygon with corners on the circle, the first on x.
    Polygon {
        radius: f64,
        sides: u32,
    },
    Rectangle {
        width: f64,
        height: f64,
    },
    /// Irradiance falls as exp(-2 r^2 / waist^2).
    Gaussian {
        waist: f64,
    },
}

/// Triangles to emit from: chosen in proportion to `cumulative`.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// Scene triangle, its corners (m), and the side that shines (front: true).
    pub triangles: Vec<(u32, [DVec3; 3], bool)>,
    /// Running sums of each triangle's weight (area, or area x cos for a collimated beam), m2.
    pub cumulative: Vec<f64>,
}

/// A place on a source.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    pub point: DVec3,
    /// z: the side it shines to.
    pub frame: Frame,
    /// Scene triangle and its shining side.
    pub triangle: Option<(u32, bool)>,
}

impl Extent {
    /// The place at two coordinates in [0, 1).
    pub fn spot(&self, u: [f64; 2]) -> Spot {
        match self {
            Extent::Flat { frame, at, outline } => {
                let place = outline.place(u);
                Spot { point: *at + place.x * frame.x + place.y * frame.y, frame: *frame, triangle: None }
            }
            Extent::Mesh(mesh) => mesh.spot(u),
        }
    }

    /// Area, m2 (0 for a point; pi waist^2 / 2, the area that at peak irradiance carries all, for a Gaussian).
    pub fn area(&self) -> f64 {
        match self {
            Extent::Flat { outline, .. } => outline.area(),
            Extent::Mesh(mesh) => mesh.cumulative.last().copied().unwrap_or(0.0),
        }
    }
}

impl Outline {
    /// Area, m2.
    pub fn area(&self) -> f64 {
        match *self {
            Outline::Point => 0.0,
            Outline::Disk { radius } => PI * radius * radius,
            Outline::Annulus { inner, outer } => PI * (outer * outer - inner * inner),
            Outline::Polygon { radius, sides } => 0.5 * sides as f64 * radius * radius * (TAU / sides as f64).sin(),
            Outline::Rectangle { width, height } => width * height,
            Outline::Gaussian { waist } => 0.5 * PI * waist * waist,
        }
    }

    /// Largest distance from the centre, m (Gaussian: where 1e-6 of the flux is outside).
    pub fn reach(&self) -> f64 {
        match *self {
            Outline::Point => 0.0,
            Outline::Disk { radius } | Outline::Polygon { radius, .. } => radius,
            Outline::Annulus { outer, .. } => outer,
            Outline::Rectangle { width, height } => 0.5 * width.hypot(height),
            Outline::Gaussian { waist } => waist * (0.5 * 1e6f64.ln()).sqrt(),
        }
    }

    /// Share of the flux per area at a place in its plane, 1/m2; 0 outside, and for a point.
    pub fn density(&self, place: DVec2) -> f64 {
        let squared = place.length_squared();
        let inside = match *self {
            Outline::Point => false,
            Outline::Disk { radius } => squared <= radius * radius,
            Outline::Annulus { inner, outer } => (inner * inner..=outer * outer).contains(&squared),
            Outline::Polygon { radius, sides } => {
                // The distance from the centre across the nearest side.
                let wedge = TAU / sides as f64;
                let from_middle = place.to_angle().rem_euclid(wedge) - 0.5 * wedge;
                squared.sqrt() * from_middle.cos() <= radius * (0.5 * wedge).cos()
            }
            Outline::Rectangle { width, height } => place.x.abs() <= 0.5 * width && place.y.abs() <= 0.5 * height,
            Outline::Gaussian { waist } => {
                let (peak, waist2) = (1.0 / self.area(), waist * waist);
                return peak * (-2.0 * squared / waist2).exp();
            }
        };
        if inside { 1.0 / self.area() } else { 0.0 }
    }

    fn place(&self, [u, v]: [f64; 2]) -> DVec2 {
        let polar = |radius: f64| radius * DVec2::from_angle(TAU * v);
        match *self {
            Outline::Point => DVec2::ZERO,
            Outline::Disk { radius } => radius * sampling::disc([u, v]),
            Outline::Annulus { inner, outer } => polar((inner * inner + u * (outer * outer - inner * inner)).sqrt()),
            Outline::Polygon { radius, sides } => {
                // v picks a wedge (and what is left of it the place along the chord), sqrt(u) the distance from the centre.
                let wedge = (v * sides as f64).min(sides as f64 - 1e-9);
                let corner = |k: f64| radius * DVec2::from_angle(TAU * k / sides as f64);
                u.sqrt() * corner(wedge.floor()).lerp(corner(wedge.floor() + 1.0), wedge.fract())
            }
            Outline::Rectangle { width, height } => DVec2::new((u - 0.5) * width, (v - 0.5) * height),
            // Enclosed flux 1 - exp(-2 r^2 / w^2) = u.
            Outline::Gaussian { waist } => polar(waist * (-0.5 * (1.0 - u).ln()).sqrt()),
        }
    }
}

impl Mesh {
    fn spot(&self, [u, v]: [f64; 2]) -> Spot {
        let total = self.cumulative.last().copied().unwrap_or(0.0);
        let target = u * total;
        let index = self.cumulative.partition_point(|&c| c <= target).min(self.triangles.len() - 1);
        let before = if index == 0 { 0.0 } else { self.cumulative[index - 1] };
        let rest = ((target - before) / (self.cumulative[index] - before)).clamp(0.0, 1.0);
        let (triangle, corners, front) = self.triangles[index];
        let [a, b, c] = sampling::triangle([rest, v]);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        Spot {
            point: a * corners[0] + b * corners[1] + c * corners[2],
            frame: Frame::from_z(if front { normal } else { -normal }),
            triangle: Some((triangle, front)),
        }
    }
}
