//! Films whose truth is known, rendered with all that spoils a picture.

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
