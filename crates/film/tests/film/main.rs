//! Films whose true values are known, rendered with noise, blur and other faults of real pictures.

mod accuracy;
mod board;
mod cameras;
mod render;
mod servo;
mod several;
mod slide;
mod studio;
mod troubles;
mod turns;
mod walk;
