"""LS-DEM: penalty contact of surface nodes on level sets, explicit in time."""
