//! The study file: every way of writing one, and every fault with its line and key.
