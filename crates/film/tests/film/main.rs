//! Films whose true values are known, rendered with noise, blur and other faults of real pictures.

mod accuracy;
mod cameras;
mod several;
mod slide;
mod studio;
mod troubles;
mod turns;
