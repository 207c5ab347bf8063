"""Trajectories, skins, edges and volumes of yarns, in closed form."""
