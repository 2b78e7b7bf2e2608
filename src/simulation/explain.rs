//! What a scene causes.
