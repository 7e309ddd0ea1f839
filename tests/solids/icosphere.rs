//! The most even closed sphere of triangles.

use glam::DVec3;

/// Icosahedron with every face divided in four `levels` times, corners on the unit sphere: 20 x 4^levels triangles.
pub fn icosphere(levels: u32) -> Vec<[DVec3; 3]> {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let corner = |i: usize| {
        let (a, b) = ([-1.0, 1.0, -1.0, 1.0][i % 4], [g, g, -g, -g][i % 4]);
        [DVec3::new(a, b, 0.0), DVec3::new(0.0, a, b), DVec3::new(b, 0.0, a)][i / 4].normalize()
    };
    #[rustfmt::skip]
    const FACES: [[usize; 3]; 20] = [
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6],
        [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10],
        [8, 6, 7], [9, 8, 1],
    ];
    let mut faces: Vec<_> = FACES.iter().map(|f| f.map(corner)).collect();
    for _ in 0..levels {
        faces = faces.into_iter().flat_map(quarter).collect();
    }
    faces
}

fn quarter([a, b, c]: [DVec3; 3]) -> [[DVec3; 3]; 4] {
    // a + b = b + a: neighbours compute the same bits.
    let (ab, bc, ca) = ((a + b).normalize(), (b + c).normalize(), (c + a).normalize());
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}
