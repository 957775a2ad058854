//! Renders the sky of a spherical planet from Airlight's optical tables.

pub mod atmosphere;
pub mod bench;
pub mod camera;
mod carried;
pub mod cases;
mod cholesky;
pub mod cli;
mod clock;
pub mod compare;
pub mod convention;
pub mod data;
pub mod doctor;
pub mod film;
pub mod gallery;
pub mod geometry;
pub mod ground;
pub mod light;
mod lookup;
pub mod phase;
pub mod plan;
pub mod polarisation;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod sequence;
pub mod spectrum;
pub mod study;
pub mod sweep;
pub mod transport;
mod vectors;

#[cfg(test)]
mod test_data;
