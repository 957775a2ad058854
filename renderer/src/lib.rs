//! Renders the sky of a spherical planet from Airlight's optical tables.
