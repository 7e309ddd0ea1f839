//! A train of spheres with two reflections, unfolded: paraxially, and by exact rays in a plane through the axis.

/// A surface on the axis.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// z of the vertex, m.
    pub place: f64,
    /// 1/m
    pub curvature: f64,
    /// m
    pub semi: f64,
    /// Before and behind it.
    pub indices: [f64; 2],
    /// Of flux, before and behind it, 1/m.
    pub absorption: [f64; 2],
    /// Of what does not transmit.
    pub reflectance: Option<f64>,
}

/// What a surface does on the way: its place in the train, whether it reflects, and whether light runs towards +z.
type Turn = (usize, bool, bool);

/// From the first surface to the last, reflected at `first`, then at `second` before it.
pub fn turns(count: usize, [first, second]: [usize; 2]) -> Vec<Turn> {
    let there = (0..first).map(|at| (at, false, true)).chain([(first, true, true)]);
    let back = (second + 1..first).rev().map(|at| (at, false, false)).chain([(second, true, false)]);
    there.chain(back).chain((second + 1..count - 1).map(|at| (at, false, true))).collect()
}

/// A bundle on the last surface: share of the flux, height per height of the beam, focus behind the surface (m).
#[derive(Clone, Copy, Debug)]
pub struct Paraxial {
    pub flux: f64,
    pub height: f64,
    pub focus: f64,
    /// Largest height at a surface over its semi-diameter, for a beam of 1 m.
    pub fullest: f64,
}

/// n' u' = n u - y c (n' - n), with negative indices where light runs backwards; R and T at normal incidence.
pub fn paraxial(train: &[Vertex], pair: [usize; 2]) -> Paraxial {
    let (mut y, mut u, mut z, mut flux, mut fullest) = (1.0, 0.0, train[0].place, 1.0, 0f64);
    for (at, reflects, onward) in turns(train.len(), pair) {
        let Vertex { place, curvature, semi, indices: [before, behind], absorption, reflectance } = train[at];
        flux *= (-absorption[!onward as usize] * (place - z).abs()).exp();
        y += u * (place - z);
        z = place;
        fullest = fullest.max(y.abs() / semi);
        let sign = if onward { 1.0 } else { -1.0 };
        let (n, m) = if onward { (before, behind) } else { (-behind, -before) };
        let r = reflectance.unwrap_or(((before - behind) / (before + behind)).powi(2));
        let next = if reflects { -n } else { m };
        u = (n * u - y * curvature * (next - n)) / next;
        flux *= if reflects { r } else { 1.0 - r };
        assert!(sign * n > 0.0);
    }
    y += u * (train[train.len() - 1].place - z);
    fullest = fullest.max(y.abs() / train[train.len() - 1].semi);
    Paraxial { flux, height: y, focus: -y / u, fullest }
}

/// A ray in the plane x = 0: (y, z), and its direction.
#[derive(Clone, Copy)]
struct Ray {
    at: [f64; 2],
    along: [f64; 2],
}

/// Share of unpolarised light that enters parallel to the axis at height `y` (m) and arrives by the pair; 0 if it is vignetted. All rays run in
/// one plane, so s and p stay apart.
pub fn exact(train: &[Vertex], bores: &[([f64; 2], f64)], pair: [usize; 2], y: f64) -> f64 {
    let mut ray = Ray { at: [y, train[0].place - 5e-3], along: [0.0, 1.0] };
    let mut shares = [0.5; 2];
    for (at, reflects, onward) in turns(train.len(), pair) {
        let vertex = &train[at];
        let Some((new, normal)) = reach(&ray, vertex) else { return 0.0 };
        if new[0].abs() > vertex.semi || blocked(bores, ray.at, new) {
            return 0.0;
        }
        let flight = (new[0] - ray.at[0]).hypot(new[1] - ray.at[1]);
        shares = shares.map(|share| share * (-vertex.absorption[!onward as usize] * flight).exp());
        let [n, m] = if onward { vertex.indices } else { [vertex.indices[1], vertex.indices[0]] };
        let cosine = normal[0] * ray.along[0] + normal[1] * ray.along[1];
        let sine = (n / m) * (1.0 - cosine * cosine).max(0.0).sqrt();
        let other = (1.0 - sine * sine).max(0.0).sqrt();
        let root = |a: f64, b: f64| ((a - b) / (a + b)).powi(2);
        let (cos1, total) = (cosine.abs(), sine >= 1.0);
        let fresnel = [root(n * cos1, m * other), root(m * cos1, n * other)];
        for (share, r) in shares.iter_mut().zip(fresnel) {
            let r = vertex.reflectance.unwrap_or(if total { 1.0 } else { r });
            *share *= if reflects { r } else { 1.0 - r };
        }
        let along = |i: usize| match reflects {
            true => ray.along[i] - 2.0 * cosine * normal[i],
            false => (n / m) * ray.along[i] + cosine.signum() * (other - (n / m) * cos1) * normal[i],
        };
        ray = Ray { at: new, along: [along(0), along(1)] };
        if shares == [0.0; 2] {
            return 0.0;
        }
    }
    let image = &train[train.len() - 1];
    match reach(&ray, image) {
        Some((at, _)) if at[0].abs() <= image.semi && !blocked(bores, ray.at, at) => shares[0] + shares[1],
        _ => 0.0,
    }
}

/// Where a ray meets the cap of a sphere about its vertex, and the unit normal there.
fn reach(ray: &Ray, vertex: &Vertex) -> Option<([f64; 2], [f64; 2])> {
    let c = vertex.curvature;
    let q = [ray.at[0], ray.at[1] - vertex.place];
    let d = ray.along;
    let b = c * (q[0] * d[0] + q[1] * d[1]) - d[1];
    let k = c * (q[0] * q[0] + q[1] * q[1]) - 2.0 * q[1];
    let root = b * b - c * k;
    if root < 0.0 {
        return None;
    }
    // The one of two points that is nearer to the vertex.
    let t = k / (-b + d[1].signum() * root.sqrt());
    let at = [ray.at[0] + t * d[0], ray.at[1] + t * d[1]];
    let normal = [-c * at[0], 1.0 - c * (at[1] - vertex.place)];
    let length = normal[0].hypot(normal[1]);
    (t > 0.0 && normal[1] > 0.0).then_some((at, normal.map(|x| x / length)))
}

/// Whether a straight flight leaves a bore; its radius is largest at one of the ends.
fn blocked(bores: &[([f64; 2], f64)], from: [f64; 2], to: [f64; 2]) -> bool {
    let [low, high] = [from[1].min(to[1]), from[1].max(to[1])];
    let height = |z: f64| from[0] + (to[0] - from[0]) * (z - from[1]) / (to[1] - from[1]);
    bores.iter().any(|([begin, end], radius)| {
        let [first, last] = [begin.max(low), end.min(high)];
        first <= last && height(first).abs().max(height(last).abs()) > *radius
    })
}
