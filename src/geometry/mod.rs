//! Points, directions, triangles, and the one question asked of them: what does this ray meet next?

pub mod bvh;
pub mod frame;
pub mod mesh;
pub mod ray;
pub mod triangle;

pub use frame::Frame;
pub use ray::Ray;
pub use triangle::Triangle;
