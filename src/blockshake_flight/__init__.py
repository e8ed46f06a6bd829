"""Diagnosis of drops and tosses of one body over a level ground: free flight first, then impacts, then whole paths.

`blockshake.measurement.campaigns.kinds` alone knows of this package, and calls it for campaigns without base motion.
"""
