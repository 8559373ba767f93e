//! What a cycle costs.

fn main() {}
