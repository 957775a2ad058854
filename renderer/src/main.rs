//! The command `airlight`.

fn main() {}
