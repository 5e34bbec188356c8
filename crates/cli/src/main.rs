//! The program `hasard`.
fn main() {}
