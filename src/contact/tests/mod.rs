mod law;
mod rings;
mod surfaces;
