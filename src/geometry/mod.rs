//! Points, directions, triangles, and the one question asked of them: what does this ray meet next?

mod bvh;
mod crossing;
pub mod exact;
pub mod fit;
pub mod frame;
mod leaf;
pub mod mesh;
mod nearest;
pub mod ray;
mod shear;
mod tree;
pub mod triangle;
mod wide;

pub use bvh::{Body, Bvh};
pub use crossing::{Crossing, Hit, Left, MOST_COINCIDENT};
pub use frame::{Frame, rotation};
pub use ray::Ray;
pub use triangle::Triangle;
