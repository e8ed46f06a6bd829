"""Diagnosis of a campaign of drops and tosses: free flight first, then impacts, then whole paths."""
